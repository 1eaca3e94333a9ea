//! What the binary must know of its own making: the commit, hashes of the sources that decide a
//! number, and the files of `campaigns/`, embedded so that it works in an empty folder.

use sha2::Digest;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// Crates whose sources decide a number of an encounter, its verdicts or their statistics.
const ENGINE: [&str; 7] = ["geom", "record", "planner-api", "encounter", "sim", "rules", "stats"];
/// Crates whose sources decide what a planner of the registry orders.
const PLANNERS: [&str; 1] = ["planners"];
/// What of the repository this binary is made of: these decide whether the sources were as
/// committed, and a change of these alone runs this script again.
const SOURCES: [&str; 5] =
    ["crates", "campaigns", "Cargo.toml", "Cargo.lock", "rust-toolchain.toml"];
/// What was measured of the tool, for evidence packs.
const MEASURED: &str = "docs/measured";
/// Crates whose sources decide a byte of a report or an evidence pack.
const RENDERER: [&str; 6] = ["summary", "table", "report", "evidence", "campaign", "seatrial"];

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let lock = fs::read(root.join("Cargo.lock")).unwrap_or_default();
    let rustc = output(&env::var("RUSTC").unwrap_or("rustc".into()), &["--version"], &root);
    let set = |key: &str, value: &str| println!("cargo::rustc-env=SEATRIAL_{key}={value}");
    set("GIT_COMMIT", &output("git", &["rev-parse", "HEAD"], &root).unwrap_or("unknown".into()));
    // without the lock git does not refresh its index, which is watched below
    let status = ["--no-optional-locks", "status", "--porcelain", "--untracked-files=no", "--"];
    let changed = output("git", &[&status[..], &SOURCES[..]].concat(), &root);
    set("GIT_CLEAN", if changed.as_deref() == Some("") { "true" } else { "false" });
    let rustc = rustc.unwrap_or("unknown".into());
    set("RUSTC", &rustc);
    set("ENGINE", &hash_sources(&root, &ENGINE, &[&lock, rustc.as_bytes()]));
    set("PLANNERS", &hash_sources(&root, &PLANNERS, &[]));
    let templates: Vec<Vec<u8>> = ["report", "evidence"]
        .iter()
        .flat_map(|name| {
            let folder = root.join("crates").join(name).join("templates");
            ["html", "css", "js"].into_iter().flat_map(move |ending| files(&folder, ending))
        })
        .map(|path| fs::read(path).unwrap_or_default())
        .collect();
    let templates: Vec<&[u8]> = templates.iter().map(Vec::as_slice).chain([&lock[..]]).collect();
    set("RENDERER", &hash_sources(&root, &RENDERER, &templates));
    set("LOCK_SHA256", &hex(&sha2::Sha256::digest(&lock)));
    embed_campaigns(&root);
    embed_bench(&root, &rustc);
    let watched = SOURCES.iter().chain([&MEASURED]).map(|path| root.join(path));
    for path in watched.chain(commit_files(&root)) {
        if path.exists() {
            println!("cargo::rerun-if-changed={}", path.display());
        }
    }
}

/// The files of git that change with the commit. Git is asked for them: in a worktree `.git` is a
/// file, and the branch lies in the folder that all worktrees share.
fn commit_files(root: &Path) -> Vec<PathBuf> {
    let branch = output("git", &["symbolic-ref", "--quiet", "HEAD"], root);
    let names = ["HEAD", "index", "packed-refs"].map(str::to_owned).into_iter().chain(branch);
    let place = |name: String| output("git", &["rev-parse", "--git-path", &name], root);
    names.filter_map(place).map(|path| root.join(path)).collect()
}

fn output(program: &str, arguments: &[&str], folder: &Path) -> Option<String> {
    let output = Command::new(program).args(arguments).current_dir(folder).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

fn hash_sources(root: &Path, crates: &[&str], more: &[&[u8]]) -> String {
    let mut hasher = blake3::Hasher::new();
    for name in crates {
        let folder = root.join("crates").join(name);
        for path in files(&folder.join("src"), "rs") {
            let relative = path.strip_prefix(&folder).unwrap_or(&path);
            hasher.update(relative.to_string_lossy().as_bytes());
            hasher.update(&fs::read(&path).unwrap_or_default());
        }
    }
    more.iter().for_each(|bytes| {
        hasher.update(bytes);
    });
    hasher.finalize().to_hex().to_string()
}

/// The files below a folder with this ending, sorted.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(files(&path, ending));
        } else if path.extension().is_some_and(|e| e == ending) {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn embed_campaigns(root: &Path) {
    let folder = root.join("campaigns");
    let mut code = String::from("pub(crate) const FILES: &[(&str, &str)] = &[\n");
    for path in files(&folder, "toml") {
        let name = path.strip_prefix(&folder).unwrap_or(&path).display().to_string();
        let full = path.canonicalize().unwrap_or(path);
        writeln!(code, "    ({name:?}, include_str!({:?})),", full.display().to_string())
            .expect("writing to a string");
    }
    code.push_str("];\n");
    let target = Path::new(&env::var("OUT_DIR").expect("cargo sets OUT_DIR")).join("campaigns.rs");
    fs::write(target, code).expect("OUT_DIR can be written");
}

/// The tool's own documents for an evidence pack: what was measured, how each check reads its rule,
/// how the binary was built.
fn embed_bench(root: &Path, rustc: &str) {
    let out = env::var("OUT_DIR").expect("cargo sets OUT_DIR");
    let out = Path::new(&out);
    fs::write(out.join("readings.json"), readings(root)).expect("OUT_DIR can be written");
    fs::write(out.join("built.json"), built(rustc)).expect("OUT_DIR can be written");
    let folder = root.join(MEASURED);
    let mut code = String::from("pub(crate) const MEASURED: &[(&str, &str)] = &[\n");
    for path in ["json", "md"].into_iter().flat_map(|ending| files(&folder, ending)) {
        let name = path.strip_prefix(&folder).unwrap_or(&path).display().to_string();
        let full = path.canonicalize().unwrap_or(path);
        writeln!(code, "    ({name:?}, include_str!({:?})),", full.display().to_string())
            .expect("writing to a string");
    }
    code.push_str("];\n");
    fs::write(out.join("bench.rs"), code).expect("OUT_DIR can be written");
}

/// Target, profile and flags as JSON.
fn built(rustc: &str) -> String {
    let of = |key: &str| env::var(key).unwrap_or_default();
    let features: Vec<String> = env::vars()
        .filter_map(|(key, _)| key.strip_prefix("CARGO_FEATURE_").map(str::to_lowercase))
        .collect();
    let pairs = [
        ("target", of("TARGET")),
        ("profile", of("PROFILE")),
        ("optimisation of this crate", of("OPT_LEVEL")),
        ("flags", of("CARGO_ENCODED_RUSTFLAGS").replace('\u{1f}', " ")),
        ("features", features.join(" ")),
        ("rustc", rustc.to_owned()),
    ];
    json_object(pairs.iter().map(|(key, value)| (*key, value.as_str())), "") + "\n"
}

/// The heads of the files of `rules` that say how a check reads its rule, as JSON.
fn readings(root: &Path) -> String {
    let folder = root.join("crates/rules/src");
    let entries: Vec<String> =
        files(&folder, "rs").iter().filter_map(|path| reading(path)).collect();
    format!("[\n{}\n]\n", entries.join(",\n"))
}

/// The paragraphs of a file's head: the rule, its words, `Reading:` and `Source:`.
fn reading(path: &Path) -> Option<String> {
    let text = fs::read_to_string(path).ok()?;
    let head = text.lines().map_while(|line| line.strip_prefix("//!")).map(str::trim);
    let mut parts = [String::new(), String::new(), String::new(), String::new()];
    let mut part = 0;
    for line in head {
        let (next, line) = match line {
            "" => (part.max(1), line),
            _ => match (line.strip_prefix("Reading"), line.strip_prefix("Source:")) {
                (Some(rest), _) => {
                    (2, rest.trim_start_matches(", first match").trim_start_matches(':'))
                }
                (_, Some(rest)) => (3, rest),
                _ => (part, line),
            },
        };
        part = next;
        if !parts[part].is_empty() && !line.is_empty() {
            parts[part].push(' ');
        }
        parts[part].push_str(line.trim());
    }
    let [rule, text, reading, source] = &parts;
    if reading.is_empty() {
        return None;
    }
    let file = path.file_name()?.to_string_lossy().into_owned();
    let pairs = [
        ("file", file.as_str()),
        ("rule", rule),
        ("text", text),
        ("reading", reading),
        ("source", source),
    ];
    Some(json_object(pairs.into_iter(), "  "))
}

/// An object of strings, one to a line.
fn json_object<'a>(pairs: impl Iterator<Item = (&'a str, &'a str)>, indent: &str) -> String {
    let escape = |text: &str| text.replace('\\', "\\\\").replace('"', "\\\"");
    let lines: Vec<String> =
        pairs.map(|(key, value)| format!("{indent}  \"{key}\": \"{}\"", escape(value))).collect();
    format!("{indent}{{\n{}\n{indent}}}", lines.join(",\n"))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
