//! Gzip streams with several members, or with other data behind them.

use std::io::{self, BufRead, Read};
use std::path::Path;

use flate2::bufread::GzDecoder;
use walpha_base::shown::shown;

use crate::formats::is_gzip;

/// Reads the content of the members of a gzip stream, one after the other. Like gzip, it ends where no other member follows.
/// Zeros behind the last member are skipped, and so is anything else, with a warning.
pub struct Gunzip<R> {
    /// `None` at the end.
    member: Option<GzDecoder<R>>,
    /// The name of the file for warnings; `None` for no warnings.
    name: Option<String>,
}

impl<R: BufRead> Gunzip<R> {
    /// Creates a reader at the first member.
    pub fn new(path: &Path, stream: R) -> Self {
        Self { name: Some(shown(path)), ..Self::quiet(stream) }
    }

    /// Like [`new`](Self::new), without warnings: for a look at the first bytes.
    pub fn quiet(stream: R) -> Self {
        Self { member: Some(GzDecoder::new(stream)), name: None }
    }

    /// Moves from the end of a member to the next one, or to the end.
    fn next_member(&mut self, mut rest: R) -> io::Result<()> {
        let start = rest.fill_buf()?;
        // At the end of a buffer only one byte may be available.
        if is_gzip(start) || start == [0x1f] {
            self.member = Some(GzDecoder::new(rest));
            return Ok(());
        }
        loop {
            let bytes = rest.fill_buf()?;
            if bytes.is_empty() {
                return Ok(());
            }
            if bytes.iter().any(|&byte| byte != 0) {
                if let Some(name) = &self.name {
                    tracing::warn!("{name}: what follows its gzip data is passed over");
                }
                return Ok(());
            }
            let length = bytes.len();
            rest.consume(length);
        }
    }
}

impl<R: BufRead> Read for Gunzip<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while let Some(member) = &mut self.member {
            let found = member.read(buffer)?;
            if found > 0 || buffer.is_empty() {
                return Ok(found);
            }
            let rest = self.member.take().expect("it was there").into_inner();
            self.next_member(rest)?;
        }
        Ok(0)
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufReader, Write};

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn members_are_joined_and_what_follows_is_passed_over() {
        let members = [gzip(b"one, "), gzip(b""), gzip(b"two")].concat();
        for tail in [&b""[..], &[0; 700], b"garbage", &[0, 0, 7]] {
            let stream = [&members[..], tail].concat();
            for size in [1, 2, 8192] {
                let mut text = String::new();
                Gunzip::quiet(BufReader::with_capacity(size, &stream[..]))
                    .read_to_string(&mut text)
                    .unwrap();
                assert_eq!(text, "one, two", "{tail:?}, {size}");
            }
        }
        let cut = &members[..members.len() - 9];
        let error = Gunzip::quiet(cut).read_to_end(&mut Vec::new()).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::UnexpectedEof);
    }
}
