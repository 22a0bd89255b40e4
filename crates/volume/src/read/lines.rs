use std::io::{self, BufRead, Read};

/// Longer lines than this are data taken for a header.
const MAX_LINE: u64 = 1 << 20;

/// Lines of a header before data of any kind, with the number of bytes they took.
pub struct Lines<R> {
    reader: R,
    bytes: u64,
}

impl<R: BufRead> Lines<R> {
    /// At the first line.
    pub fn new(reader: R) -> Self {
        Self { reader, bytes: 0 }
    }

    /// The next line without its end (LF or CR LF); `None` at the end of the file. Bytes that are
    /// no UTF-8 are replaced.
    ///
    /// # Errors
    /// What the system says.
    pub fn read_line(&mut self) -> io::Result<Option<String>> {
        let mut line = Vec::new();
        let found = (&mut self.reader).take(MAX_LINE).read_until(b'\n', &mut line)? as u64;
        if found == MAX_LINE {
            let what = "a line of its header has no end within 1 MB";
            return Err(io::Error::new(io::ErrorKind::InvalidData, what));
        }
        self.bytes += found;
        if line.ends_with(b"\n") {
            line.pop();
        }
        if line.ends_with(b"\r") {
            line.pop();
        }
        Ok((found > 0).then(|| String::from_utf8_lossy(&line).into_owned()))
    }

    /// Skips bytes that are not lines.
    ///
    /// # Errors
    /// What the system says.
    pub fn skip(&mut self, bytes: u64) -> io::Result<()> {
        let passed = io::copy(&mut (&mut self.reader).take(bytes), &mut io::sink())?;
        self.bytes += passed;
        Ok(())
    }

    /// Whether nothing follows.
    ///
    /// # Errors
    /// What the system says.
    pub fn at_end(&mut self) -> io::Result<bool> {
        Ok(self.reader.fill_buf()?.is_empty())
    }

    /// Bytes of the lines so far.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The reader, positioned after the last line.
    pub fn into_inner(self) -> R {
        self.reader
    }
}
