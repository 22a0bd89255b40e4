//! Why a file cannot be read as a volume or as points.

use std::fmt;

use walpha_base::advice::{Advice, Setting, advice};

/// Why a file cannot be read, whatever its format. Its text follows the name of the file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// Its format is not known.
    Unknown {
        /// The formats that can be read.
        known: String,
        /// A known extension that is similar to its own.
        near: Option<&'static str>,
    },
    /// Its content does not match the format that its extension, or the header that refers to it, implies.
    Other {
        /// What it is not, and how this can be seen.
        what: String,
    },
    /// It ends too early.
    Truncated {
        /// Where it ends, or what it claims.
        what: String,
    },
    /// Its header claims more or fewer bytes than follow it.
    Length {
        /// The claim.
        claim: String,
        /// The number of bytes that the claim needs.
        needed: u64,
        /// The number of bytes that exist.
        found: u64,
        /// "", "at most " or "at least "; the latter two if the bytes are not counted.
        bound: &'static str,
    },
    /// Its header misses something or contradicts itself.
    Header {
        /// The field, and what is wrong with it.
        what: String,
    },
    /// A line or number in it is invalid.
    Value {
        /// The place of the value, and the value.
        what: String,
    },
    /// Its content is damaged.
    Damaged {
        /// The contradiction.
        what: String,
    },
    /// It is valid, but its content is not supported.
    Unsupported {
        /// What it contains, and what can be read.
        what: String,
        /// What to do instead.
        advice: Advice,
    },
    /// The feature that reads it was not built in.
    Without {
        /// What it is.
        what: &'static str,
        /// The feature's name.
        feature: &'static str,
    },
    /// It contains no samples or no points, or samples or points that do not fit together.
    Content {
        /// What it contains.
        what: String,
        /// What to do about it.
        advice: Advice,
    },
    /// It has several values in each voxel: colours, vectors or tensors.
    NotScalar {
        /// The kind of values, and what can be read.
        what: String,
        /// The number of samples along x, y and z, if they are known.
        dims: Option<[u64; 3]>,
    },
    /// It contains several volumes, and `frame` is missing or out of range.
    Several {
        /// The number of volumes.
        count: u64,
    },
    /// A setting does not apply to it, is missing, or names something that it does not have.
    Setting {
        /// The setting.
        setting: Setting,
        /// What the file is or has.
        what: String,
        /// What to do with the setting.
        advice: Advice,
    },
    /// A part of it cannot be read: an array, or the data files that a header names.
    Within {
        /// The part.
        part: String,
        /// What is wrong with it.
        reason: Box<Reason>,
    },
    /// There is not enough memory for its content.
    Memory {
        /// What it contains.
        claim: String,
        /// The number of bytes needed.
        needed: u64,
    },
}

impl Reason {
    /// Creates [`Reason::Other`].
    pub fn other(what: impl Into<String>) -> Self {
        Self::Other { what: what.into() }
    }

    /// Creates [`Reason::Truncated`].
    pub fn truncated(what: impl Into<String>) -> Self {
        Self::Truncated { what: what.into() }
    }

    /// The reason for a claim of more than exists: the file ends too early, or the claim is wrong.
    pub fn claims_more(what: impl Into<String>) -> Self {
        Self::content(what, "copy it again, or correct its header")
    }

    /// Creates [`Reason::Header`].
    pub fn header(what: impl Into<String>) -> Self {
        Self::Header { what: what.into() }
    }

    /// Creates [`Reason::Value`].
    pub fn value(what: impl Into<String>) -> Self {
        Self::Value { what: what.into() }
    }

    /// Creates [`Reason::Damaged`].
    pub fn damaged(what: impl Into<String>) -> Self {
        Self::Damaged { what: what.into() }
    }

    /// Creates [`Reason::Unsupported`].
    pub fn unsupported(what: impl Into<String>, advice: impl Into<Advice>) -> Self {
        Self::Unsupported { what: what.into(), advice: advice.into() }
    }

    /// Creates [`Reason::Content`].
    pub fn content(what: impl Into<String>, advice: impl Into<Advice>) -> Self {
        Self::Content { what: what.into(), advice: advice.into() }
    }

    /// The reason for a file with several values in each voxel.
    pub fn not_scalar(what: impl Into<String>, dims: Option<[u64; 3]>) -> Self {
        let what = format!("{}: only scalar volumes are read", what.into());
        Self::NotScalar { what, dims }
    }

    /// The reason for a setting that does not apply to the file.
    pub fn needless(setting: Setting, what: impl Into<String>) -> Self {
        Self::Setting { setting, what: what.into(), advice: advice!["omit ", setting] }
    }

    /// The reason for a setting that is missing or names something that does not exist.
    pub fn choice(setting: Setting, what: impl Into<String>, advice: Advice) -> Self {
        Self::Setting { setting, what: what.into(), advice }
    }

    /// What to do about it.
    pub fn advice(&self) -> Advice {
        match self {
            Self::Unknown { near, .. } => {
                let near = near.map(|near| format!("is .{near} meant? ")).unwrap_or_default();
                advice![
                    near,
                    "for raw samples give ",
                    Setting::Dims,
                    " X,Y,Z and ",
                    Setting::Dtype
                ]
            }
            Self::Other { .. } => "check its name and what is in it".into(),
            Self::Truncated { .. } => "copy it again".into(),
            Self::Damaged { .. } => {
                "it was damaged or written wrongly: write it anew with the program that made it".into()
            }
            Self::Length { needed, found, .. } if found < needed => {
                "copy it again, or correct its header".into()
            }
            Self::Length { .. } | Self::Header { .. } => {
                "correct its header, or write it anew with the program that made it".into()
            }
            Self::Value { .. } => "correct it".into(),
            Self::Without { feature, .. } => format!(
                "build it with `cargo install --path . --features {feature}`, or convert the file to \
                 another format"
            )
            .into(),
            Self::Memory { .. } => "crop it first".into(),
            Self::NotScalar { .. } => "extract one first".into(),
            Self::Several { count } => {
                let last = count.saturating_sub(1);
                advice!["choose one with ", Setting::Frame, format!(", from 0 to {last}")]
            }
            Self::Within { reason, .. } => reason.advice(),
            Self::Unsupported { advice, .. }
            | Self::Content { advice, .. }
            | Self::Setting { advice, .. } => advice.clone(),
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { known, .. } => {
                write!(
                    f,
                    "is not in a format that is recognised by its content: {known} are read as volumes"
                )
            }
            Self::Length { claim, needed, found, bound } => {
                let state = if found < needed { "truncated" } else { "too long" };
                write!(
                    f,
                    "its header claims {claim}, {needed} bytes, but {bound}{found} follow it: the \
                     file is {state} or mislabelled"
                )
            }
            Self::Memory { claim, needed } => {
                write!(f, "{claim} needs {needed} bytes of memory, more than is available")
            }
            Self::Within { part, reason } => write!(f, "{part} {reason}"),
            Self::NotScalar { what, .. } => write!(f, "has {what}"),
            Self::Several { count: 1 } => write!(f, "holds 1 volume"),
            Self::Several { count } => write!(f, "holds {count} volumes"),
            Self::Without { what, .. } => {
                write!(f, "is {what}, which this walpha was built without")
            }
            Self::Other { what }
            | Self::Truncated { what }
            | Self::Header { what }
            | Self::Value { what }
            | Self::Damaged { what }
            | Self::Unsupported { what, .. }
            | Self::Content { what, .. }
            | Self::Setting { what, .. } => f.write_str(what),
        }
    }
}
