//! Numbers as people read them.

/// What stands where there is no number.
pub(crate) const NONE: &str = "–";

/// 12345 as `12,345`.
pub(crate) fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// 12345 as `12k`: for cells without room.
pub(crate) fn short_count(n: u64) -> String {
    match n {
        0..10_000 => n.to_string(),
        10_000..10_000_000 => format!("{}k", n / 1000),
        _ => format!("{}M", n / 1_000_000),
    }
}

/// A share as per cent with three significant digits: `0.0123 %`.
pub(crate) fn per_cent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 3))
}

/// As [`per_cent`], or the sign for none.
pub(crate) fn per_cent_or_none(share: Option<f64>) -> String {
    share.map_or_else(|| NONE.to_owned(), per_cent)
}

/// A number with so many decimals, or the sign for none; minus zero is zero.
pub(crate) fn fixed(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(
        || NONE.to_owned(),
        |value| {
            let text = format!("{value:.decimals$}");
            if text.bytes().all(|b| matches!(b, b'-' | b'0' | b'.')) {
                text.replace('-', "")
            } else {
                text.replace('-', "\u{2212}")
            }
        },
    )
}

/// A number with so many significant digits, without an exponent; 0 is `0`, 1 is `1`.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value.abs() < f64::MIN_POSITIVE {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return NONE.to_owned();
    }
    // The exponent from the decimal text: no logarithm, whose last bit could move the result.
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let exponent: i32 =
        scientific.rsplit_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or_default();
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// A text cut to so many letters, with a sign that it was cut.
pub(crate) fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.to_owned();
    }
    text.chars().take(letters.saturating_sub(1)).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts() {
        assert_eq!(
            [0, 999, 1000, 1_234_567].map(count),
            ["0", "999", "1,000", "1,234,567"].map(str::to_owned)
        );
        assert_eq!([9_999, 10_000, 12_345_678].map(short_count), ["9999", "10k", "12M"]);
    }

    #[test]
    fn shares() {
        assert_eq!(per_cent(0.0), "0 %");
        assert_eq!(per_cent(1.0), "100 %");
        assert_eq!(per_cent(0.001_234_5), "0.123 %");
        assert_eq!(per_cent(0.000_002_996), "0.0003 %");
        assert_eq!(per_cent(0.5), "50 %");
        assert_eq!(per_cent(0.999_999), "100 %");
    }

    #[test]
    fn decimals() {
        assert_eq!(fixed(Some(-0.01), 1), "0.0");
        assert_eq!(fixed(Some(-1.25), 1), "\u{2212}1.2");
        assert_eq!(fixed(None, 1), NONE);
    }
}
