//! The origin of the volume, and whether it can be the paper's volume.

use serde::Serialize;

use super::{ReproduceError, Subject};
use crate::pipeline::paper::SAMPLES;
use crate::volume::{SKULL_SHA256, skull_sha256};

/// The origin of the volume, and whether it can be the paper's volume.
#[derive(Clone, Debug, Serialize)]
pub struct Origin {
    /// A description of its source.
    pub source: String,
    /// The SHA-256 of the file, for CGAL's skull only.
    pub sha256: Option<Checksum>,
    /// Whether it can be the paper's, and why.
    pub judgement: String,
}

/// A SHA-256 in hexadecimal: that of the file that was read, and that of the file that the judgement is about.
#[derive(Clone, Debug, Serialize)]
pub struct Checksum {
    /// The checksum of the file that was read.
    pub read: String,
    /// The checksum of `skull_2.9.inr` in CGAL 5.5.
    pub expected: &'static str,
}

/// The name of the skull on the command line.
const SKULL: &str = "sample:skull";

impl Origin {
    /// # Errors
    /// The file of the skull cannot be read again.
    pub(super) fn of(subject: &Subject<'_>) -> Result<Self, ReproduceError> {
        if subject.name != SKULL {
            return Ok(Self::other(subject));
        }
        let read = skull_sha256()?;
        let judgement = if read == SKULL_SHA256 {
            OF_THE_SKULL.into()
        } else {
            "This is not the file that CGAL 5.5 has, which alone was compared with what the paper says.".into()
        };
        Ok(Self {
            source: "CGAL's own data: skull_2.9.inr, an INRIMAGE of 64 × 64 × 64 floats, in Debian's and Ubuntu's \
                     package libcgal-demo. The file does not say who scanned it."
                .into(),
            sha256: Some(Checksum { read, expected: SKULL_SHA256 }),
            judgement,
        })
    }

    fn other(subject: &Subject<'_>) -> Self {
        let samples = subject.volume.dims().samples();
        let size = if samples == SAMPLES {
            "It has as many samples as the paper's"
        } else {
            "It does not have the paper's 64 × 64 × 64 samples, so it is another volume"
        };
        Self {
            source: format!("{}, as given.", subject.name),
            sha256: None,
            judgement: format!(
                "{size}. What the paper says of its own skull, a verdict on another volume cannot settle."
            ),
        }
    }
}

/// The judgement on the file with this checksum, whose numbers are known.
const OF_THE_SKULL: &str = "It may show the paper's skull, but it is not known to, and it is not the same data if the \
     paper's gray levels were bytes. For it: it is a skull, has the paper's 64 × 64 × 64 samples, and comes with the \
     library that the paper used. Against it: the paper gives gray levels in the range from 0 to 255, and this file has \
     213528 different values in 262144 samples, where bytes have 256; and no reading of the paper's threshold of 50 \
     that was tried leaves as many samples as the paper says (Figure 5). The paper names neither a source nor a \
     checksum, and prints no number of its shapes, so this cannot be settled. Claims about the method do not depend on \
     it; those about holes in Figures 10 and 11 do.";
