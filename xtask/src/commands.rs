//! The commands: those of the product are handed on word for word, the others are here.

use crate::run::{become_command, cargo, root};
use crate::tidy;
use anyhow::{Result, bail};
use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::{Command, ExitCode, Stdio};

/// A command of the product and what it does, for the help.
const PRODUCT: &[(&str, &str)] = &[
    ("campaign", "run a campaign: encounters, verdicts, table, report (default: quick)"),
    ("replay", "run one encounter of a finished campaign again and compare its digest"),
    ("planners", "list the planners"),
    ("speed", "measure encounters per second and where the time goes"),
    ("vectors", "check the seed planner against a file of known answers"),
    ("compare", "several planners on the same encounters, side by side"),
    ("judge", "another rule set over a finished campaign, every encounter run again from its seed"),
    ("manoeuvres", "turning circle, zigzag and crash stop of every vessel"),
    ("fit-ais", "fit an encounter model to AIS reports"),
    ("gate", "candidate against baseline: pass, fail or inconclusive"),
    ("baseline", "store the baseline of the gate"),
    ("shrink", "reduce a failing encounter to a small one that fails in the same way"),
    ("corpus", "run the gate's corpus: every case must get the verdict that its file holds"),
    ("intervals", "check exact binomial intervals against a file of known answers"),
    ("evidence", "write an evidence pack of a finished campaign"),
    ("verify", "check an evidence pack"),
    ("conformance", "run the conformance kit against a planner"),
    ("missing", "list the parts of a sharded campaign that are not there"),
    ("merge", "put the parts of a sharded campaign together"),
    ("slurm", "write the job array of a sharded campaign"),
];

/// A command of this program and what it does.
const OWN: &[(&str, &str)] = &[
    ("tidy", "check dependency edges, file sizes, manifests and forbidden words"),
    ("ci", "run the stages of .ci/run (all, or those named)"),
    ("e2e", "run the report in a real browser and the binary end to end (tests/e2e/run)"),
    ("example-pack", "make reports/example-pack anew (tests/e2e/example-pack)"),
    ("e2e-slurm", "run a campaign on a real Slurm of this machine (tests/slurm/run; minutes)"),
    ("mutants", "mutation tests of the judges and the statistics (hours; needs cargo-mutants)"),
];

/// What `cargo xtask --help` prints.
pub(crate) fn help() -> String {
    let mut text = String::from(
        "cargo xtask COMMAND [ARGS...]\n\n\
         Commands of the product (each has its own --help; they are built optimised first,\n\
         which takes some minutes the first time and seconds later):\n",
    );
    let list = |text: &mut String, commands: &[(&str, &str)]| {
        for (name, what) in commands {
            writeln!(text, "  {name:<12} {what}").expect("a String takes every write");
        }
    };
    list(&mut text, PRODUCT);
    text.push_str("\nCommands of this repository:\n");
    list(&mut text, OWN);
    text.push_str(
        "\nFirst steps: `cargo xtask campaign`, then open the report it names;\n\
         `cargo xtask ci` runs what continuous integration runs.\n\n\
         Exit codes: 0 done, also with collisions found; 1 a check asked for has failed;\n\
         2 usage or input; 3 inconclusive, incomplete or interrupted; 4 harness fault.\n",
    );
    text
}

/// Runs the command of this name.
pub(crate) fn dispatch(name: &str, rest: Vec<OsString>) -> Result<ExitCode> {
    match name {
        "help" | "--help" | "-h" => {
            print!("{}", help());
            Ok(ExitCode::SUCCESS)
        }
        "tidy" => tidy::run(&rest),
        "ci" => script(".ci/run", &rest),
        "e2e" => script("tests/e2e/run", &rest),
        "example-pack" => script("tests/e2e/example-pack", &rest),
        "e2e-slurm" => script("tests/slurm/run", &rest),
        "mutants" => mutants(&rest),
        name if PRODUCT.iter().any(|(known, _)| *known == name) => product(name, &rest),
        name => bail!("there is no command `{name}`; `cargo xtask --help` lists them"),
    }
}

/// Builds the product and becomes it. Cargo's own progress stays visible: a silent first build of
/// some minutes looks like a hang.
fn product(name: &str, rest: &[OsString]) -> Result<ExitCode> {
    let root = root();
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
    if !target.join("debug").join("seatrial").exists() {
        eprintln!("building the product first; from nothing this takes three to four minutes");
    }
    let mut command = cargo();
    command.args(["run", "--locked", "--package", "seatrial"]);
    command.arg("--config").arg(root.join(".cargo/optimised.toml"));
    command.arg("--manifest-path").arg(root.join("Cargo.toml"));
    command.arg("--").arg(name).args(rest);
    become_command(command)
}

fn script(path: &str, rest: &[OsString]) -> Result<ExitCode> {
    let script = root().join(path);
    if !script.exists() {
        bail!("this checkout has no `{path}`");
    }
    let mut command = Command::new(script);
    command.args(rest).current_dir(root());
    become_command(command)
}

/// Mutation tests of the crates whose numbers people act on. Each mutant meets only the tests of
/// its own crate: seconds a mutant, and a survivor shows what those tests do not hold.
fn mutants(rest: &[OsString]) -> Result<ExitCode> {
    let probe =
        cargo().args(["mutants", "--version"]).stdout(Stdio::null()).stderr(Stdio::null()).status();
    if !probe.is_ok_and(|status| status.success()) {
        bail!("cargo-mutants is not installed; `cargo install --locked cargo-mutants` does that");
    }
    let mut command = cargo();
    command.args(["mutants", "--package", "rules", "--package", "stl", "--package", "stats"]);
    command.args(["--test-workspace", "false"]);
    command.args(rest).current_dir(root());
    become_command(command)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_help_names_every_command_once_with_what_it_does() {
        let text = help();
        for (name, what) in PRODUCT.iter().chain(OWN) {
            let line = format!("  {name:<12} {what}\n");
            assert_eq!(text.matches(&line).count(), 1, "{name}");
        }
    }

    #[test]
    fn an_unknown_command_is_an_error_that_says_where_to_look() {
        let error = dispatch("campain", Vec::new()).unwrap_err().to_string();
        assert!(error.contains("`campain`") && error.contains("--help"), "{error}");
    }
}
