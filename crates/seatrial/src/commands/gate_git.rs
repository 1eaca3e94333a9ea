//! `git:REV`: the binary of another commit, built in a worktree with the shared target folder.

use campaign::Error;
use std::ffi::OsStr;
use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Builds REV and returns its binary; none when REV is what this binary was built from.
pub(super) fn build(revision: &str) -> Result<Option<PathBuf>, Error> {
    let commit = commit(revision)?;
    let mine = crate::build::build();
    if mine.git_clean && mine.git_commit == commit {
        return Ok(None);
    }
    let root = PathBuf::from(git(&["rev-parse", "--show-toplevel"])?);
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
    let folder = target.join("gate");
    let kept = folder.join(format!("seatrial-{commit}"));
    if kept.is_file() {
        return Ok(Some(kept));
    }
    fs::create_dir_all(&folder).map_err(Error::io("make", &folder))?;
    let tree = folder.join(format!("tree-{commit}"));
    let shown = tree.display().to_string();
    // an interrupted gate may have left one that is not whole
    if tree.is_dir() {
        fs::remove_dir_all(&tree).map_err(Error::io("remove", &tree))?;
    }
    git(&["worktree", "prune"])?;
    git(&["worktree", "add", "--detach", &shown, &commit])?;
    eprintln!("building {revision} ({}) to run beside the present planner", &commit[..12]);
    let built = build_tree(&tree, &target, revision, &kept);
    git(&["worktree", "remove", "--force", &shown])?;
    built.map(|()| Some(kept))
}

/// The commit of a revision.
pub(super) fn commit(revision: &str) -> Result<String, Error> {
    let wanted = format!("{revision}^{{commit}}");
    // a word that begins with a dash is no revision, whatever git makes of it
    let known = git(&["rev-parse", "--verify", "--quiet", "--end-of-options", &wanted]);
    git(&["rev-parse", "--git-dir"])?;
    known.map_err(|_| {
        Error::input(format!(
            "git:{revision}: this repository has no such revision; a branch, a tag or a commit \
             will do, and a shallow clone has few"
        ))
    })
}

/// Builds into the shared target folder, where cargo puts the binary in the place of the present
/// one; that one is put back.
///
/// Cargo names what it compiles after the place of a package in its workspace, which is the same in
/// both trees, and tells old from new by the times of files: the next build of the present sources
/// could take crates of REV for its own. A wrapper of the compiler of workspace members is part of
/// those names, so that each commit has its own; dependencies know no wrapper and are shared.
fn build_tree(tree: &Path, target: &Path, revision: &str, kept: &Path) -> Result<(), Error> {
    // as `cargo xtask` builds, so that dependencies are compiled once; older revisions had
    // `release`
    let optimised = tree.join(".cargo/optimised.toml");
    let (folder, settings) = if optimised.is_file() {
        ("debug", [OsStr::new("--config"), optimised.as_os_str()].to_vec())
    } else {
        ("release", [OsStr::new("--release")].to_vec())
    };
    let place = target.join(folder).join("seatrial");
    let present = kept.with_extension("present");
    let was_there = place.is_file();
    if was_there {
        fs::copy(&place, &present).map_err(Error::io("copy", &place))?;
    }
    let wrapper = wrapper(kept)?;
    let built = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["build", "--locked", "--quiet", "--package", "seatrial"])
        .args(settings)
        .current_dir(tree)
        .env("CARGO_TARGET_DIR", target)
        .env("RUSTC_WORKSPACE_WRAPPER", &wrapper)
        .status();
    let ended = match built {
        // by rename, so that a binary under this name is always whole
        Ok(status) if status.success() => {
            fs::rename(&place, kept).map_err(Error::io("move", &place))
        }
        // Ctrl-C reaches cargo too
        Ok(_) if super::gate::was_interrupted() => {
            Err(Error::Incomplete(format!("interrupted while git:{revision} was built")))
        }
        Ok(status) => Err(Error::input(format!("git:{revision} does not build ({status})"))),
        Err(error) => Err(Error::input(format!("failed to start cargo: {error}"))),
    };
    drop(fs::remove_file(&wrapper));
    if was_there {
        fs::rename(&present, &place).map_err(Error::io("put back", &place))?;
    }
    ended
}

/// A program of a name of its own that runs the compiler as it is.
fn wrapper(kept: &Path) -> Result<PathBuf, Error> {
    let path = kept.with_extension("rustc");
    fs::write(&path, "#!/bin/sh\nexec \"$@\"\n").map_err(Error::io("write", &path))?;
    let executable = fs::Permissions::from_mode(0o755);
    fs::set_permissions(&path, executable).map_err(Error::io("make executable", &path))?;
    path.canonicalize().map_err(Error::io("find", &path))
}

/// What git says; an error is the user's to mend.
pub(super) fn git(arguments: &[&str]) -> Result<String, Error> {
    let output = Command::new("git")
        .args(arguments)
        .output()
        .map_err(|e| Error::input(format!("failed to start git: {e}")))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(Error::input(format!("git {}: {}", arguments[0], said.trim())));
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
