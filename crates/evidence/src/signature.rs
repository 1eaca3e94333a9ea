//! The signature of the statement, in minisign's format.
//!
//! Signing runs the program `minisign`, so that neither secret key nor password passes through
//! this tool; checking needs nothing but the public key.

use crate::EvidenceError;
use minisign_verify::{PublicKey, Signature};
use std::path::Path;
use std::process::Command;

/// The signature, inside the pack.
pub const SIGNATURE: &str = "statement.intoto.json.minisig";
/// The one line of a signature file that its signature does not cover, so it must be this.
pub const SIGNATURE_COMMENT: &str = "seatrial evidence pack";

/// What a verifier can say of a signature.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SignatureState {
    /// The pack has none: who can write the folder can make it anew.
    Unsigned,
    /// There is one, but no public key was given to check it with.
    NotChecked,
    /// Made by the owner of the given key, over this very statement.
    Good,
    /// Not so; with the reason.
    Bad(String),
}

/// Signs a statement that is there as a file.
///
/// # Errors
/// `minisign` is not installed or refuses.
pub fn sign(statement: &Path, secret_key: &Path) -> Result<(), EvidenceError> {
    let status = Command::new("minisign")
        .args(["-S", "-c", SIGNATURE_COMMENT, "-t", SIGNATURE_COMMENT, "-s"])
        .arg(secret_key)
        .arg("-m")
        .arg(statement)
        .status()
        .map_err(|e| EvidenceError::Sign(format!("{e}; it is a program of its own, install it")))?;
    if status.success() {
        Ok(())
    } else {
        Err(EvidenceError::Sign(format!("it ended with {status}")))
    }
}

/// Checks a signature; `public_key` is the line of a minisign `.pub` file that is no comment.
pub fn check_signature(
    statement: &[u8],
    signature: Option<&[u8]>,
    public_key: Option<&str>,
) -> SignatureState {
    let Some(bytes) = signature else {
        return match public_key {
            Some(_) => SignatureState::Bad("a key was given, but there is no signature".to_owned()),
            None => SignatureState::Unsigned,
        };
    };
    let bad = |what: &str| SignatureState::Bad(what.to_owned());
    let Ok(text) = std::str::from_utf8(bytes) else {
        return bad("the signature is not text");
    };
    if !text.starts_with(&format!("untrusted comment: {SIGNATURE_COMMENT}\n")) {
        return bad("the signature's comment was changed");
    }
    if text.lines().count() != 4 || !text.ends_with('\n') || text.contains('\r') {
        return bad("the signature does not have four lines");
    }
    let Ok(signature) = Signature::decode(text) else {
        return bad("the signature is damaged");
    };
    let Some(key) = public_key else { return SignatureState::NotChecked };
    let Ok(key) = PublicKey::from_base64(key.trim()) else {
        return bad("the given public key is none");
    };
    match key.verify(statement, &signature, false) {
        Ok(()) => SignatureState::Good,
        Err(error) => SignatureState::Bad(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_signature_it_depends_on_what_was_asked() {
        assert_eq!(check_signature(b"x", None, None), SignatureState::Unsigned);
        assert!(matches!(check_signature(b"x", None, Some("k")), SignatureState::Bad(_)));
        assert!(matches!(check_signature(b"x", Some(b"?"), None), SignatureState::Bad(_)));
    }
}
