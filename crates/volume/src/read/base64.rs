use std::io::{self, BufRead, Read};

/// Decodes base64 (RFC 4648) as VTK writes it: white space is passed over, and padding may end one
/// piece of data in the middle of the text, where the next begins.
pub(super) struct Base64<R> {
    text: R,
    /// Decoded bytes not yet given out, and how many were.
    ready: [u8; 3],
    length: usize,
    given: usize,
}

impl<R: BufRead> Base64<R> {
    pub(super) fn new(text: R) -> Self {
        Self { text, ready: [0; 3], length: 0, given: 0 }
    }

    /// Decodes the next four characters; `false` at the end of the text.
    fn refill(&mut self) -> io::Result<bool> {
        let mut group = [0; 4];
        let mut filled = 0;
        while filled < 4 {
            let buffer = self.text.fill_buf()?;
            if buffer.is_empty() {
                break;
            }
            let mut used = 0;
            for &byte in buffer {
                used += 1;
                if !byte.is_ascii_whitespace() {
                    group[filled] = byte;
                    filled += 1;
                    if filled == 4 {
                        break;
                    }
                }
            }
            self.text.consume(used);
        }
        if filled == 0 {
            return Ok(false);
        }
        let (ready, length) = decode(group).filter(|_| filled == 4).ok_or_else(|| {
            io::Error::new(io::ErrorKind::InvalidData, "its base64 text is cut off or damaged")
        })?;
        (self.ready, self.length, self.given) = (ready, length, 0);
        Ok(true)
    }
}

impl<R: BufRead> Read for Base64<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let mut written = 0;
        while written < out.len() {
            if self.given == self.length && !self.refill()? {
                break;
            }
            let count = (self.length - self.given).min(out.len() - written);
            out[written..written + count].copy_from_slice(&self.ready[self.given..][..count]);
            self.given += count;
            written += count;
        }
        Ok(written)
    }
}

/// Up to three bytes of four characters.
fn decode(group: [u8; 4]) -> Option<([u8; 3], usize)> {
    let padding = group.iter().rev().take_while(|&&character| character == b'=').count();
    let mut bits = 0u32;
    for (i, character) in group.into_iter().enumerate() {
        let six = match character {
            b'A'..=b'Z' => character - b'A',
            b'a'..=b'z' => character - b'a' + 26,
            b'0'..=b'9' => character - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            b'=' if i + padding >= 4 => 0,
            _ => return None,
        };
        bits = bits << 6 | u32::from(six);
    }
    let [_, a, b, c] = bits.to_be_bytes();
    (padding <= 2).then(|| ([a, b, c], 3 - padding))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(text: &str) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        Base64::new(text.as_bytes()).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    /// The examples of RFC 4648, section 10.
    #[test]
    fn text_becomes_bytes() {
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            (" Zm9v\nYm Fy\n", "foobar"),
            ("Zg==Zm9v", "ffoo"),
        ] {
            assert_eq!(decoded(text).unwrap(), bytes.as_bytes(), "{text}");
        }
        for text in ["Z", "Zg=", "Z===", "====", "Zg=v", "Zm9*"] {
            assert!(decoded(text).is_err(), "{text}");
        }
    }
}
