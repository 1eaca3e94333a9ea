//! The identity of an encounter: which stratum, and which draw of it.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

/// (stratum, j), written `head_on/001234`. It depends on no number of encounters, thread, shard
/// or other stratum, so a longer campaign extends a shorter one.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct EncounterId {
    /// Name of the stratum, as in the campaign file.
    pub stratum: Arc<str>,
    /// Which draw of the stratum, from 0.
    pub j: u64,
}

impl EncounterId {
    /// The largest `j` that fits the packed stream number.
    pub const J_MAX: u64 = (1 << 48) - 1;

    /// The `j`-th encounter of `stratum`.
    pub fn new(stratum: impl Into<Arc<str>>, j: u64) -> Self {
        assert!(j <= Self::J_MAX, "encounter number {j} does not fit 48 bits");
        Self { stratum: stratum.into(), j }
    }

    /// The id as a file name: `head_on-001234`.
    pub fn file_stem(&self) -> String {
        let safe = |c: char| if c.is_ascii_alphanumeric() || c == '_' { c } else { '-' };
        format!("{}-{:06}", self.stratum.chars().map(safe).collect::<String>(), self.j)
    }
}

impl fmt::Display for EncounterId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{:06}", self.stratum, self.j)
    }
}

/// What is wrong with a text that should be an encounter id.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is not an encounter id; one looks like `head_on/001234`")]
pub struct ParseIdError(String);

impl FromStr for EncounterId {
    type Err = ParseIdError;

    fn from_str(text: &str) -> Result<Self, ParseIdError> {
        let wrong = || ParseIdError(text.to_owned());
        let (stratum, j) = text.rsplit_once('/').ok_or_else(wrong)?;
        if stratum.is_empty() || j.is_empty() || !j.bytes().all(|b| b.is_ascii_digit()) {
            return Err(wrong());
        }
        let j: u64 = j.parse().map_err(|_| wrong())?;
        if j > Self::J_MAX {
            return Err(wrong());
        }
        Ok(Self::new(stratum, j))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn writes_and_reads() {
        let id = EncounterId::new("head_on", 1234);
        assert_eq!(id.to_string(), "head_on/001234");
        assert_eq!("head_on/001234".parse::<EncounterId>(), Ok(id));
        let long = EncounterId::new("HO, HO/x", 123_456_789);
        assert_eq!(long.to_string().parse::<EncounterId>(), Ok(long.clone()));
        assert_eq!(long.file_stem(), "HO--HO-x-123456789");
    }

    #[test]
    fn refuses_what_is_none() {
        for text in
            ["", "head_on", "head_on/", "/1", "head_on/x", "head_on/-1", "a/999999999999999999"]
        {
            assert!(text.parse::<EncounterId>().is_err(), "{text}");
        }
    }
}
