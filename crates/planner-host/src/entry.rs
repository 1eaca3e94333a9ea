//! A planner's name on the command line, `exec:COMMAND` or `lib:FILE`, becomes a registry entry.

use crate::child::Limits;
use crate::exec::ExecPlanner;
use crate::library::LibraryPlanner;
use planner_api::{Options, OptionsError, PlannerEntry};
use std::path::{Path, PathBuf};
use std::time::Duration;
use toml::Value;

/// Where a planner from outside lives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OutsideKind {
    /// A process: program and arguments.
    Exec(Vec<String>),
    /// A shared library.
    Lib(PathBuf),
}

/// The options of `exec:` with their defaults. Below the ten seconds after which the supervisor of
/// a campaign takes a beat for endless, so that this limit, which knows the planner, comes first.
const EXEC_OPTIONS: [(&str, f64); 4] = [
    ("call_limit_s", 5.0),
    ("start_limit_s", 8.0),
    ("memory_limit_mib", 1024.0),
    ("output_limit_kib", 1024.0),
];

/// The entry of a planner from outside; none for a name of the registry. Nothing is run here: a
/// missing file is an error at once, what a process or a library then does is an outcome.
pub fn outside(name: &str) -> Option<Result<PlannerEntry, OptionsError>> {
    let kind = parse(name)?;
    Some(kind.map(|kind| match kind {
        OutsideKind::Exec(argv) => exec_entry(name.to_owned(), argv),
        OutsideKind::Lib(path) => lib_entry(name.to_owned(), path),
    }))
}

/// The files that a planner's owner brings, as its name writes them: a library, and the words of a
/// command that are paths of files. A program that is found in `PATH`, such as an interpreter, is
/// the machine's. None for a name of the registry.
pub fn files(name: &str) -> Vec<String> {
    match parse(name) {
        Some(Ok(OutsideKind::Exec(argv))) => {
            let named = |(i, word): &(usize, String)| {
                (*i > 0 || word.contains('/')) && Path::new(word).is_file()
            };
            argv.into_iter().enumerate().filter(named).map(|(_, word)| word).collect()
        }
        Some(Ok(OutsideKind::Lib(_))) => {
            vec![name.strip_prefix("lib:").unwrap_or(name).to_owned()]
        }
        Some(Err(_)) | None => Vec::new(),
    }
}

/// The entry of [`outside`] with some of its files taken from elsewhere: `place` gets a file as the
/// name writes it, and says where it lies now. The name stays what it was.
pub fn relocated(
    name: &str,
    place: &dyn Fn(&str) -> Option<PathBuf>,
) -> Option<Result<PlannerEntry, OptionsError>> {
    let moved = |word: &str| {
        place(word).map_or_else(|| word.to_owned(), |path| path.to_string_lossy().into_owned())
    };
    if let Some(command) = name.strip_prefix("exec:") {
        let Some(argv) = split(command) else { return outside(name) };
        let argv: Vec<String> = argv.iter().map(|word| moved(word)).collect();
        return Some(match argv.first().filter(|program| find_program(program).is_some()) {
            Some(_) => Ok(exec_entry(name.to_owned(), argv)),
            None => Err(bad(name, "its program cannot be run here")),
        });
    }
    let path = name.strip_prefix("lib:")?;
    Some(parse_lib(name, &moved(path)).map(|kind| match kind {
        OutsideKind::Lib(path) => lib_entry(name.to_owned(), path),
        OutsideKind::Exec(argv) => exec_entry(name.to_owned(), argv),
    }))
}

fn parse(name: &str) -> Option<Result<OutsideKind, OptionsError>> {
    if let Some(command) = name.strip_prefix("exec:") {
        return Some(parse_exec(name, command));
    }
    name.strip_prefix("lib:").map(|path| parse_lib(name, path))
}

fn parse_exec(name: &str, command: &str) -> Result<OutsideKind, OptionsError> {
    let argv = split(command).ok_or_else(|| bad(name, "a quotation mark is not closed"))?;
    let Some(program) = argv.first() else {
        return Err(bad(name, "no program; say `exec:./my_planner --flag`"));
    };
    if find_program(program).is_none() {
        return Err(bad(name, &format!("there is no program `{program}` that can be run")));
    }
    Ok(OutsideKind::Exec(argv))
}

fn parse_lib(name: &str, path: &str) -> Result<OutsideKind, OptionsError> {
    let path = Path::new(path);
    if !path.is_file() {
        return Err(bad(name, &format!("there is no file `{}`", path.display())));
    }
    // Without a slash the loader would search the system's folders instead.
    let path = if path.components().count() == 1 { Path::new(".").join(path) } else { path.into() };
    Ok(OutsideKind::Lib(path))
}

fn exec_entry(name: String, argv: Vec<String>) -> PlannerEntry {
    let options = EXEC_OPTIONS.iter().map(|(key, value)| ((*key).to_owned(), Value::Float(*value)));
    let label = name.clone();
    PlannerEntry {
        summary: "a process that speaks JSON lines".to_owned(),
        caught_by: None,
        options: options.collect(),
        make: Box::new(move |options| {
            Ok(Box::new(ExecPlanner::new(argv.clone(), limits(&label, options)?)))
        }),
        name,
    }
}

fn lib_entry(name: String, path: PathBuf) -> PlannerEntry {
    let label = name.clone();
    PlannerEntry {
        summary: "a shared library with the C interface".to_owned(),
        caught_by: None,
        options: Options::new(),
        make: Box::new(move |_| match LibraryPlanner::load(&path) {
            Ok(planner) => Ok(Box::new(planner)),
            Err(reason) => Err(bad(&label, &reason)),
        }),
        name,
    }
}

fn limits(name: &str, options: &Options) -> Result<Limits, OptionsError> {
    let mut values = [0.0; EXEC_OPTIONS.len()];
    for ((key, default), value) in EXEC_OPTIONS.iter().zip(&mut values) {
        *value = match options.get(*key) {
            None => *default,
            Some(Value::Float(number)) => *number,
            Some(Value::Integer(number)) => *number as f64,
            Some(_) => return Err(bad(name, &format!("`{key}` is not a number"))),
        };
        if !value.is_finite() || *value < 1e-3 || *value > 1e9 {
            return Err(bad(name, &format!("`{key}` is not between 0.001 and 1e9")));
        }
    }
    let [call_s, start_s, memory_mib, output_kib] = values;
    Ok(Limits {
        call: Duration::from_secs_f64(call_s),
        start: Duration::from_secs_f64(start_s),
        memory_bytes: (memory_mib * 1024.0 * 1024.0) as u64,
        output_bytes: (output_kib * 1024.0) as usize,
    })
}

fn bad(name: &str, reason: &str) -> OptionsError {
    OptionsError::BadValue { planner: name.to_owned(), reason: reason.to_owned() }
}

/// The words of a command: blanks part them, single or double quotation marks keep them together.
/// No shell is involved, so nothing else has a meaning.
fn split(command: &str) -> Option<Vec<String>> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut quote = None;
    for c in command.chars() {
        match quote {
            Some(mark) if c == mark => quote = None,
            Some(_) => word.get_or_insert_default().push(c),
            None if c == '"' || c == '\'' => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            None if c.is_whitespace() => words.extend(word.take()),
            None => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    quote.is_none().then_some(words)
}

/// The file that a program's name means: itself with a slash, else the first in `PATH`.
fn find_program(program: &str) -> Option<PathBuf> {
    use std::os::unix::fs::PermissionsExt as _;
    let runs = |path: &PathBuf| {
        path.metadata().is_ok_and(|file| file.is_file() && file.permissions().mode() & 0o111 != 0)
    };
    if program.contains('/') {
        return Some(PathBuf::from(program)).filter(runs);
    }
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(program)).find(runs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_split_without_a_shell() {
        let words = |command| split(command).unwrap_or_default();
        assert_eq!(words("./a --flag  x"), ["./a", "--flag", "x"]);
        assert_eq!(words("sh -c 'a b' \"c'd\" ''"), ["sh", "-c", "a b", "c'd", ""]);
        assert_eq!(words("a$B;c"), ["a$B;c"]);
        assert_eq!(split("a 'b"), None);
    }

    #[test]
    fn names_of_the_registry_are_not_ours_and_bad_ones_say_what_is_wrong() {
        assert!(outside("hold-course").is_none());
        for (name, word) in [
            ("exec:", "no program"),
            ("exec:./no-such-planner", "no-such-planner"),
            ("exec:sh 'x", "quotation mark"),
            ("lib:./no-such.so", "no-such.so"),
        ] {
            let error = outside(name).unwrap().err().unwrap().to_string();
            assert!(error.contains(word), "{name}: {error}");
        }
        assert!(outside("exec:sh -c true").unwrap().is_ok());
    }

    #[test]
    fn an_owners_files_are_those_named_by_path_and_may_lie_elsewhere() {
        let folder = std::env::temp_dir();
        let script = folder.join(format!("seatrial-entry-{}.sh", std::process::id()));
        std::fs::write(&script, "true").unwrap();
        let word = script.display().to_string();
        let name = format!("exec:sh {word} --flag");
        assert_eq!(files(&name), std::slice::from_ref(&word));
        assert_eq!(files(&format!("lib:{word}")), std::slice::from_ref(&word));
        assert_eq!(files("exec:sh --flag"), Vec::<String>::new());
        assert_eq!(files("hold-course"), Vec::<String>::new());
        std::fs::remove_file(&script).unwrap();
        // the interpreter is asked for as before, the script where it is said to lie
        let entry = relocated(&name, &|file| (file == word).then(|| "/elsewhere/x.sh".into()));
        assert_eq!(entry.unwrap().unwrap().name, name);
        assert!(relocated("exec:./gone", &|_| Some("/elsewhere/gone".into())).unwrap().is_err());
        assert!(relocated("lib:./gone.so", &|_| None).unwrap().is_err());
        assert!(relocated("hold-course", &|_| None).is_none());
    }

    #[test]
    fn limits_are_options_and_are_checked() {
        let entry = outside("exec:sh").unwrap().unwrap();
        let change = |key: &str, value: Value| {
            let options = entry.resolve(&[(key.to_owned(), value)].into_iter().collect())?;
            limits("x", &options)
        };
        let limits = change("call_limit_s", Value::Integer(2)).unwrap();
        assert_eq!(limits.call, Duration::from_secs(2));
        assert_eq!(limits.memory_bytes, 1 << 30);
        assert!(change("call_limit_s", Value::Float(f64::NAN)).is_err());
        assert!(change("call_limit_s", Value::Float(0.0)).is_err());
        assert!(change("call_limit_s", Value::String("2".to_owned())).is_err());
        assert!(change("call_limit", Value::Float(1.0)).is_err());
    }
}
