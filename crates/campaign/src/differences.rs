//! What differs between two plans, in words.

use serde_json::Value;

/// What differs between two plans, as at most four `key: there, here` texts. The commit is no
/// difference while engine and planners are the same.
pub(crate) fn differences(there: &Value, here: &Value) -> Vec<String> {
    const SHOWN: usize = 4;
    let mut found = Vec::new();
    compare("", there, here, &mut found);
    found.retain(|text: &String| !text.starts_with("build.git_"));
    if found.len() > SHOWN {
        let more = found.len() - SHOWN;
        found.truncate(SHOWN);
        found.push(format!("and {more} more"));
    }
    found
}

fn compare(key: &str, there: &Value, here: &Value, found: &mut Vec<String>) {
    match (there, here) {
        (Value::Object(a), Value::Object(b)) => {
            let mut keys: Vec<&String> = a.keys().chain(b.keys()).collect();
            keys.sort();
            keys.dedup();
            for name in keys {
                let path = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                let null = &Value::Null;
                compare(&path, a.get(name).unwrap_or(null), b.get(name).unwrap_or(null), found);
            }
        }
        (a, b) if a != b => {
            found.push(format!("{key} is {} there and {} here", brief(a), brief(b)))
        }
        _ => {}
    }
}

fn brief(value: &Value) -> String {
    const LONGEST: usize = 40;
    let text = value.to_string();
    if text.chars().count() <= LONGEST {
        text
    } else {
        text.chars().take(LONGEST).chain("...".chars()).collect()
    }
}
