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
/// Crates whose sources decide a byte of a report or an evidence pack.
const RENDERER: [&str; 6] = ["summary", "table", "report", "evidence", "campaign", "seatrial"];

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let lock = fs::read(root.join("Cargo.lock")).unwrap_or_default();
    let rustc = output(&env::var("RUSTC").unwrap_or("rustc".into()), &["--version"], &root);
    let set = |key: &str, value: &str| println!("cargo::rustc-env=SEATRIAL_{key}={value}");
    set("GIT_COMMIT", &output("git", &["rev-parse", "HEAD"], &root).unwrap_or("unknown".into()));
    let status = ["status", "--porcelain", "--untracked-files=no", "--"];
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
    for path in SOURCES.iter().map(|path| root.join(path)).chain(commit_files(&root)) {
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

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
