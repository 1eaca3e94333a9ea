//! Numbers that JSON cannot write and planners write all the same.
//!
//! Python's `json` writes `NaN` and `Infinity`, C's `printf` writes `nan` and `-inf`, and `1e999`
//! is a JSON number that no float holds. All of them say that the planner's arithmetic failed,
//! which is another finding than a planner that cannot keep to the protocol.

/// The line with every number that is not finite replaced by `null`; none if there is no such.
pub(crate) fn with_nulls(line: &str) -> Option<String> {
    let bytes = line.as_bytes();
    let mut result = String::with_capacity(line.len());
    let (mut at, mut copied, mut found) = (0, 0, false);
    while at < bytes.len() {
        if bytes[at] == b'"' {
            at = end_of_string(bytes, at);
        } else if is_word(bytes[at]) {
            let end = at + bytes[at..].iter().take_while(|byte| is_word(**byte)).count();
            if is_not_finite(&line[at..end]) {
                result.push_str(&line[copied..at]);
                result.push_str("null");
                (copied, found) = (end, true);
            }
            at = end;
        } else {
            at += 1;
        }
    }
    result.push_str(&line[copied..]);
    found.then_some(result)
}

/// The index behind the string that begins at `at`.
fn end_of_string(bytes: &[u8], at: usize) -> usize {
    let mut escaped = false;
    for (index, byte) in bytes.iter().enumerate().skip(at + 1) {
        match byte {
            b'"' if !escaped => return index + 1,
            b'\\' => escaped = !escaped,
            _ => escaped = false,
        }
    }
    bytes.len()
}

const fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'+' | b'-' | b'.' | b'_' | b'(' | b')')
}

/// Rust reads `nan`, `inf` and `infinity` in any case and with a sign; glibc adds `nan(...)`.
fn is_not_finite(word: &str) -> bool {
    let word = word.split('(').next().unwrap_or_default();
    word.parse::<f64>().is_ok_and(|number| !number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelling_becomes_null() {
        for word in
            ["NaN", "nan", "-nan", "nan(0x1)", "Infinity", "-Infinity", "inf", "-inf", "1e999"]
        {
            let line = format!(r#"{{"order":{{"velocity_mps":[{word},1]}}}}"#);
            let expected = r#"{"order":{"velocity_mps":[null,1]}}"#;
            assert_eq!(with_nulls(&line).as_deref(), Some(expected), "{word}");
        }
    }

    #[test]
    fn strings_and_finite_numbers_are_left_alone() {
        for line in [r#"{"why":"NaN, \" inf"}"#, "[1e308,-2.5,true,null]", r#"{"inf":1}"#, "\"NaN"]
        {
            assert_eq!(with_nulls(line), None, "{line}");
        }
        assert_eq!(with_nulls(r#"["NaN",NaN]"#).as_deref(), Some(r#"["NaN",null]"#));
    }
}
