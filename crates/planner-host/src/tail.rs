//! The last lines that a planner, or an engine process with a planner in it, wrote to standard
//! error.

/// Bytes kept; enough for a Python traceback.
const BYTES_MAX: usize = 4096;
/// Lines shown.
const LINES_MAX: usize = 8;
/// Characters shown of a line.
const COLUMNS_MAX: usize = 200;

/// A window on the end of a stream.
#[derive(Debug, Default)]
pub struct Tail(Vec<u8>);

impl Tail {
    /// Takes more of the stream.
    pub fn push(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(&bytes[bytes.len().saturating_sub(BYTES_MAX)..]);
        let over = self.0.len().saturating_sub(BYTES_MAX);
        self.0.drain(..over);
    }

    /// The last lines, or that there are none, to go behind a message.
    pub fn said(&self) -> String {
        let text = String::from_utf8_lossy(&self.0);
        let lines: Vec<String> =
            text.lines().filter(|line| !line.trim().is_empty()).map(shortened).collect();
        if lines.is_empty() {
            return "; it wrote nothing to standard error".to_owned();
        }
        let from = lines.len().saturating_sub(LINES_MAX);
        format!("; its last lines on standard error:\n{}", lines[from..].join("\n"))
    }
}

/// The first characters of a line, without control characters.
pub(crate) fn shortened(line: &str) -> String {
    let clean = |c: char| if c.is_control() { ' ' } else { c };
    let mut short: String = line.chars().take(COLUMNS_MAX).map(clean).collect();
    if line.chars().nth(COLUMNS_MAX).is_some() {
        short.push_str("...");
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_end_is_kept_and_shown() {
        let mut tail = Tail::default();
        assert!(tail.said().contains("nothing"));
        for number in 0..100_000 {
            tail.push(format!("line {number}\n").as_bytes());
        }
        assert!(tail.0.len() <= BYTES_MAX);
        let said = tail.said();
        assert!(said.ends_with("line 99998\nline 99999"), "{said}");
        assert_eq!(said.lines().count(), 1 + LINES_MAX);
        tail.push(&[b'x'; 3 * BYTES_MAX]);
        assert_eq!(tail.0.len(), BYTES_MAX);
        assert!(tail.said().len() < 2 * COLUMNS_MAX);
    }
}
