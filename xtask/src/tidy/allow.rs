//! The exceptions: one line each, `rule place  # reason`.

use super::Finding;

/// The committed list.
#[derive(Debug)]
pub(crate) struct AllowList {
    entries: Vec<Entry>,
    malformed: Vec<Finding>,
}

#[derive(Debug)]
struct Entry {
    rule: String,
    place: String,
    line: usize,
}

impl AllowList {
    /// Where it stands.
    pub(crate) const PLACE: &str = "xtask/tidy-allow.txt";

    /// Reads the list; a line without a reason is a finding.
    pub(crate) fn parse(text: &str) -> Self {
        let mut list = Self { entries: Vec::new(), malformed: Vec::new() };
        for (index, line) in text.lines().enumerate() {
            let (entry, reason) = line.split_once('#').unwrap_or((line, ""));
            let words: Vec<&str> = entry.split_whitespace().collect();
            match words.as_slice() {
                [] => {}
                [rule, place] if !reason.trim().is_empty() => list.entries.push(Entry {
                    rule: (*rule).to_owned(),
                    place: (*place).to_owned(),
                    line: index + 1,
                }),
                _ => list.malformed.push(finding(
                    index + 1,
                    "an exception is `rule place  # reason`, and the reason is not optional",
                )),
            }
        }
        list
    }

    /// The findings that no line excuses, and the lines that excuse nothing.
    pub(crate) fn apply(self, findings: Vec<Finding>) -> Vec<Finding> {
        let excuses = |entry: &Entry, finding: &Finding| {
            entry.rule == finding.rule && entry.place == finding.place
        };
        let idle: Vec<Finding> = self
            .entries
            .iter()
            .filter(|entry| !findings.iter().any(|finding| excuses(entry, finding)))
            .map(|entry| finding(entry.line, "this exception excuses nothing; remove it"))
            .collect();
        findings
            .into_iter()
            .filter(|finding| !self.entries.iter().any(|entry| excuses(entry, finding)))
            .chain(self.malformed)
            .chain(idle)
            .collect()
    }
}

fn finding(line: usize, what: &str) -> Finding {
    let place = AllowList::PLACE.to_owned();
    Finding { rule: "allow-list", place, line: Some(line), what: what.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn long(place: &str) -> Finding {
        Finding { rule: "file-length", place: place.to_owned(), line: None, what: "x".to_owned() }
    }

    #[test]
    fn an_exception_needs_a_reason_and_something_to_excuse() {
        let list = AllowList::parse(
            "# a comment\n\nfile-length a.rs  # a table\nfile-length b.rs # gone\nfile-length c.rs",
        );
        let left = list.apply(vec![long("a.rs"), long("c.rs")]);
        let left: Vec<(String, Option<usize>)> =
            left.into_iter().map(|finding| (finding.place, finding.line)).collect();
        let list = AllowList::PLACE.to_owned();
        assert_eq!(
            left,
            [("c.rs".to_owned(), None), (list.clone(), Some(5)), (list, Some(4))],
            "c.rs is not excused without a reason, b.rs is not there"
        );
    }
}
