//! Digests, by which files and samples are recognised.

use std::fmt::{self, Debug, Display};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use serde::{Deserialize, Serialize};
use walpha_files::open_ordinary;

use super::BlocksError;

/// The first 128 bits of BLAKE3 of some bytes. They protect against accidents, not against deception.
#[derive(Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub(super) struct Digest([u8; 16]);

impl Digest {
    pub(super) fn of(bytes: &[u8]) -> Self {
        let mut hasher = Hasher::default();
        hasher.update(bytes);
        hasher.digest()
    }

    /// Whether this is the digest of these bytes. It is always true for fuzzers, which could never match a digest and do not have
    /// to.
    pub(super) fn is_of(self, bytes: &[u8]) -> bool {
        self.is(Self::of(bytes))
    }

    /// The bytes of the digest, as stored in files.
    pub(super) fn bytes(&self) -> &[u8] {
        &self.0
    }

    /// Reads a digest from 16 bytes.
    pub(super) fn read(bytes: &[u8]) -> Self {
        Self(bytes.try_into().expect("as many bytes as it has"))
    }

    /// Whether it equals another digest.
    pub(super) fn is(self, found: Self) -> bool {
        cfg!(fuzzing) || self == found
    }
}

impl Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Display::fmt(self, f)
    }
}

impl From<Digest> for String {
    fn from(digest: Digest) -> Self {
        digest.to_string()
    }
}

impl TryFrom<String> for Digest {
    type Error = &'static str;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        // Only the printed form is accepted, so that each digest has one text.
        let is_digit = |byte: &u8| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
        if text.len() != 32 || !text.as_bytes().iter().all(is_digit) {
            return Err("a digest has 32 digits");
        }
        let number = u128::from_str_radix(&text, 16).map_err(|_| "a digest has 32 digits")?;
        Ok(Self(number.to_be_bytes()))
    }
}

/// Computes a digest of bytes that are added piece by piece.
#[derive(Default)]
pub(super) struct Hasher(blake3::Hasher);

impl Hasher {
    pub(super) fn update(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// The first 64 bits, for digests of which there are many.
    pub(super) fn short(&self) -> u64 {
        let mut digest = [0; 8];
        self.0.finalize_xof().fill(&mut digest);
        u64::from_le_bytes(digest)
    }

    pub(super) fn digest(&self) -> Digest {
        let mut digest = [0; 16];
        self.0.finalize_xof().fill(&mut digest);
        Digest(digest)
    }
}

/// A number as it is stored in files.
pub(super) trait Number: Copy {
    const SIZE: usize;
    fn put(self, bytes: &mut Vec<u8>);
    fn get(bytes: &[u8]) -> Self;
}

macro_rules! number {
    ($($number:ty)*) => {$(
        impl Number for $number {
            const SIZE: usize = size_of::<$number>();
            fn put(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
            fn get(bytes: &[u8]) -> Self {
                Self::from_le_bytes(bytes.try_into().expect("as many bytes as it has"))
            }
        }
    )*};
}

number!(u8 u32 u64 f64);

impl<T: Number, const N: usize> Number for [T; N] {
    const SIZE: usize = N * T::SIZE;
    fn put(self, bytes: &mut Vec<u8>) {
        self.into_iter().for_each(|number| number.put(bytes));
    }
    fn get(bytes: &[u8]) -> Self {
        std::array::from_fn(|i| T::get(&bytes[i * T::SIZE..][..T::SIZE]))
    }
}

/// Converts bytes to numbers; `None` if some bytes are left over.
pub(super) fn numbers<T: Number>(bytes: &[u8]) -> Option<Vec<T>> {
    let whole = bytes.len().is_multiple_of(T::SIZE);
    whole.then(|| bytes.chunks(T::SIZE).map(T::get).collect())
}

/// Opens a file in the folder of a plan. Anything but an ordinary file counts as damaged: the target of a link does not belong to
/// the plan.
pub(super) fn open(path: &Path) -> Result<File, BlocksError> {
    let opened = open_ordinary(path);
    let opened = opened.map_err(|source| BlocksError::Io { path: path.into(), source })?;
    let what = "is a link, or not a file: neither is followed in the folder of a plan";
    opened.ok_or_else(|| BlocksError::Damaged { path: path.into(), what: what.into() })
}

/// Reads a whole file in the folder of a plan.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, BlocksError> {
    let mut bytes = Vec::new();
    let read = open(path)?.read_to_end(&mut bytes);
    read.map_err(|source| BlocksError::Io { path: path.into(), source })?;
    Ok(bytes)
}

/// The length and digest of a file, read in chunks.
pub(super) fn digest_of(file: impl Read) -> io::Result<(u64, Digest)> {
    let (mut file, mut hasher, mut length) = (file, Hasher::default(), 0);
    let mut bytes = vec![0; 1 << 18];
    loop {
        match file.read(&mut bytes) {
            Ok(0) => return Ok((length, hasher.digest())),
            Ok(count) => {
                hasher.update(&bytes[..count]);
                length += count as u64;
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digest_is_that_of_blake3_and_has_one_text() {
        let digest = Digest::of(b"");
        // This is the test vector for no bytes.
        assert_eq!(digest.to_string(), "af1349b9f5f9a1a6a0404dea36dcc949");
        assert_eq!(Digest::try_from(digest.to_string()), Ok(digest));
        let text = digest.to_string();
        for other in [text.to_uppercase(), text[1..].to_owned(), format!("+{}", &text[1..])] {
            assert!(Digest::try_from(other.clone()).is_err(), "{other}");
        }
        let mut hasher = Hasher::default();
        hasher.update(b"in ");
        hasher.update(b"pieces");
        assert!(hasher.digest() == Digest::of(b"in pieces") && digest.is_of(b""));
    }
}
