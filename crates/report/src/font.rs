//! The font of every figure and page, embedded: it looks the same where no font is installed.

/// The family names, ours first.
pub(crate) const STACK: &str = "Seatrial Sans, Helvetica, Arial, sans-serif";

const REGULAR: &[u8] = include_bytes!("../fonts/roboto-regular-subset.woff2");
const BOLD: &[u8] = include_bytes!("../fonts/roboto-bold-subset.woff2");

/// The font faces as a style sheet with the fonts inside.
pub(crate) fn face_css() -> String {
    [("normal", REGULAR), ("bold", BOLD)]
        .map(|(weight, bytes)| {
            format!(
                "@font-face{{font-family:\"Seatrial Sans\";font-weight:{weight};\
                 src:url(data:font/woff2;base64,{}) format(\"woff2\")}}",
                base64(bytes)
            )
        })
        .concat()
}

/// RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let at = |i: usize| u32::from(chunk.get(i).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for i in 0..4 {
            let digit = ALPHABET[(bits >> (18 - 6 * i) & 63) as usize] as char;
            text.push(if i <= chunk.len() { digit } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_the_rfc() {
        let cases =
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")];
        for (plain, coded) in cases {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn fonts_are_small_and_woff2() {
        assert!(REGULAR.starts_with(b"wOF2") && BOLD.starts_with(b"wOF2"));
        assert!(face_css().len() < 60_000);
    }
}
