//! `git:REV`: the binary of another commit, built in a worktree with the shared target folder.

use campaign::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Builds REV and returns its binary, under a name of its own: the next build of the shared
/// target folder writes over the one that cargo made.
pub(super) fn build(revision: &str) -> Result<PathBuf, Error> {
    let root = git(&["rev-parse", "--show-toplevel"], "this folder is in no git repository")?;
    let root = Path::new(&root);
    let wanted = format!("{revision}^{{commit}}");
    let commit = git(&["rev-parse", "--verify", "--quiet", &wanted], "there is no such revision")
        .map_err(|_| Error::input(format!("git:{revision}: there is no such revision")))?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
    let kept = target.join("gate").join(format!("seatrial-{commit}"));
    if kept.is_file() {
        return Ok(kept);
    }
    let tree = target.join("gate").join(format!("tree-{commit}"));
    fs::create_dir_all(target.join("gate")).map_err(Error::io("make", &target))?;
    let shown = tree.display().to_string();
    if !tree.is_dir() {
        git(&["worktree", "add", "--detach", &shown, &commit], "failed to make a worktree")?;
    }
    eprintln!("building {revision} ({}) as the baseline", &commit[..12]);
    let built = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["build", "--release", "--locked", "--quiet", "--package", "seatrial"])
        .current_dir(&tree)
        .env("CARGO_TARGET_DIR", &target)
        .status();
    let ended = match built {
        Ok(status) if status.success() => {
            let made = target.join("release").join("seatrial");
            fs::copy(&made, &kept).map(drop).map_err(Error::io("copy", &made))
        }
        Ok(status) => Err(Error::input(format!("git:{revision} does not build ({status})"))),
        Err(error) => Err(Error::input(format!("failed to start cargo: {error}"))),
    };
    git(&["worktree", "remove", "--force", &shown], "failed to remove the worktree")?;
    ended.map(|()| kept)
}

fn git(arguments: &[&str], otherwise: &str) -> Result<String, Error> {
    let output = Command::new("git")
        .args(arguments)
        .output()
        .map_err(|e| Error::input(format!("failed to start git: {e}")))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(Error::input(format!("{otherwise}: {}", said.trim())));
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
