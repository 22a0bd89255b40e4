//! Shards: chunks that hold chunks, and an index of where these are. The index is looked at before it is believed: the
//! reader adds an offset to a length without asking whether the sum is a number.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};

use serde_json::Value;
use zarrs::array::Array;
use zarrs::array_subset::ArraySubset;
use zarrs::filesystem::FilesystemStore;

/// How the index of a shard lies in its file.
struct Index {
    /// Chunks in a shard; each has an offset and a length of 64 bits.
    chunks: u64,
    at_start: bool,
    /// Bytes of a checksum behind it.
    sum: u64,
}

/// Whether the shards of a part of an array lead to places in their own files. Arrays without shards pass, and so do
/// shards whose index is compressed, which nobody writes.
///
/// # Errors
/// What is wrong.
pub(super) fn check(array: &Array<FilesystemStore>, part: &ArraySubset) -> io::Result<()> {
    let Some(index) = Index::of(array) else { return Ok(()) };
    let Ok(Some(shards)) = array.chunks_in_array_subset(part) else { return Ok(()) };
    let store = array.storage();
    for place in &shards.indices() {
        let path = store.key_to_fspath(&array.chunk_key(&place));
        match File::open(path) {
            Ok(file) => index.check(file)?,
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

impl Index {
    fn of(array: &Array<FilesystemStore>) -> Option<Self> {
        let metadata = serde_json::to_value(array.metadata()).ok()?;
        let codecs = metadata["codecs"].as_array()?;
        let sharding = codecs.iter().find(|codec| codec["name"] == "sharding_indexed")?;
        let about = &sharding["configuration"];
        let product = |sizes: &Value| -> Option<u64> {
            sizes
                .as_array()?
                .iter()
                .try_fold(1u64, |product, size| product.checked_mul(size.as_u64()?))
        };
        let shard = product(&metadata["chunk_grid"]["configuration"]["chunk_shape"])?;
        let chunks = shard.checked_div(product(&about["chunk_shape"])?)?;
        let mut sum = 0;
        for codec in about["index_codecs"].as_array()? {
            match codec["name"].as_str()? {
                "bytes" if codec["configuration"]["endian"] != "big" => {}
                "crc32c" => sum = 4,
                _ => return None,
            }
        }
        Some(Self { chunks, at_start: about["index_location"] == "start", sum })
    }

    /// Looks at the index of a shard.
    fn check(&self, mut shard: File) -> io::Result<()> {
        /// What an offset and a length are where there is no chunk.
        const NONE: [u64; 2] = [u64::MAX; 2];
        let wrong = |what: String| io::Error::new(ErrorKind::InvalidData, what);
        let length = shard.metadata()?.len();
        let bytes = self.chunks.checked_mul(16).filter(|bytes| *bytes <= length);
        let from = bytes.and_then(|bytes| length.checked_sub(bytes.checked_add(self.sum)?));
        let (Some(bytes), Some(from)) = (bytes, from) else {
            return Err(wrong(format!("a shard of {length} bytes is too short for its index")));
        };
        shard.seek(SeekFrom::Start(if self.at_start { 0 } else { from }))?;
        let mut index = Vec::new();
        shard.take(bytes).read_to_end(&mut index)?;
        for entry in index.as_chunks::<16>().0 {
            let [at, size] =
                [0, 8].map(|k| u64::from_le_bytes(entry[k..k + 8].try_into().expect("8 bytes")));
            if [at, size] != NONE && at.checked_add(size).is_none_or(|end| end > length) {
                return Err(wrong(format!(
                    "a shard of {length} bytes says that a chunk of {size} is at {at}"
                )));
            }
        }
        Ok(())
    }
}
