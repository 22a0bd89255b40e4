//! Several volumes in a series, such as times, echoes or stacks, and the one that a slice belongs to.

use std::cmp::Ordering;
use std::fmt;

use dicom_object::Tag;
use dicom_object::mem::InMemElement;

use super::header::Header;

const FRAME_CONTENT: Tag = Tag(0x0020, 0x9111);
const STACK_ID: Tag = Tag(0x0020, 0x9056);
const DIMENSION_INDEX_VALUES: Tag = Tag(0x0020, 0x9157);
const DIMENSION_INDICES: Tag = Tag(0x0020, 0x9222);
const DIMENSION_INDEX_POINTER: Tag = Tag(0x0020, 0x9165);
/// Indices that count places, and therefore slices of one volume.
const OF_PLACES: [Tag; 4] =
    [Tag(0x0020, 0x0032), Tag(0x0020, 0x9057), Tag(0x0020, 0x9113), Tag(0x0020, 0x1041)];

/// The elements that distinguish volumes, each with its functional group; explicit indices come before mere hints.
const INDICES: [(Option<Tag>, Tag, &str); 12] = [
    (Some(FRAME_CONTENT), Tag(0x0020, 0x9128), "Temporal Position Index"),
    (None, Tag(0x0020, 0x0100), "Temporal Position Identifier"),
    (None, Tag(0x0018, 0x0086), "Echo Numbers"),
    (Some(Tag(0x0018, 0x9114)), Tag(0x0018, 0x9082), "Effective Echo Time"),
    (None, Tag(0x0018, 0x0081), "Echo Time"),
    (Some(Tag(0x0018, 0x9117)), Tag(0x0018, 0x9087), "Diffusion b-value"),
    (None, Tag(0x0018, 0x1060), "Trigger Time"),
    (Some(Tag(0x0018, 0x9118)), Tag(0x0020, 0x9153), "Nominal Cardiac Trigger Delay Time"),
    (None, Tag(0x0054, 0x1300), "Frame Reference Time"),
    (None, Tag(0x0020, 0x0012), "Acquisition Number"),
    (None, Tag(0x0008, 0x0008), "Image Type"),
    (None, Tag(0x0008, 0x0032), "Acquisition Time"),
];

/// The vectors of nuclear medicine, which have a number for each frame.
const VECTORS: [(Tag, &str); 7] = [
    (Tag(0x0054, 0x0010), "Energy Window Vector"),
    (Tag(0x0054, 0x0020), "Detector Vector"),
    (Tag(0x0054, 0x0030), "Phase Vector"),
    (Tag(0x0054, 0x0050), "Rotation Vector"),
    (Tag(0x0054, 0x0060), "R-R Interval Vector"),
    (Tag(0x0054, 0x0070), "Time Slot Vector"),
    (Tag(0x0054, 0x0100), "Time Slice Vector"),
];

/// A number or text that distinguishes volumes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Index {
    pub name: String,
    pub value: Key,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Key {
    Number(f64),
    Text(String),
}

impl Key {
    fn of(element: &InMemElement) -> Option<Self> {
        if let Ok(numbers) = element.to_multi_float64()
            && let [number] = numbers[..]
        {
            return Some(Self::Number(number));
        }
        let text = element.to_str().ok()?;
        Some(Self::Text(text.trim_matches(['\0', ' ']).to_owned()))
    }

    pub(super) fn order(&self, other: &Self) -> Ordering {
        match (self, other) {
            (Self::Number(a), Self::Number(b)) => a.total_cmp(b),
            (Self::Text(a), Self::Text(b)) => a.cmp(b),
            (Self::Number(_), Self::Text(_)) => Ordering::Less,
            (Self::Text(_), Self::Number(_)) => Ordering::Greater,
        }
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

/// The name of the index whose values are always separate volumes, whatever the places of their slices.
pub(super) const STACK: &str = "Stack ID";

/// All properties of a frame that may distinguish volumes: its stack, its indices along dimensions other than places, then the
/// others.
pub(super) fn of_frame(header: Header<'_>, frame: u32) -> Vec<Index> {
    let index = |name: &str, value: Key| Index { name: name.to_owned(), value };
    let stack = header.element(FRAME_CONTENT, STACK_ID).and_then(Key::of);
    let mut all: Vec<Index> = stack.map(|key| index(STACK, key)).into_iter().collect();
    let pointers = header.items(None, DIMENSION_INDICES).unwrap_or_default();
    let values = header.numbers(FRAME_CONTENT, DIMENSION_INDEX_VALUES);
    for (item, &value) in pointers.iter().zip(&values) {
        let pointer = item.get(DIMENSION_INDEX_POINTER);
        let tag = pointer.and_then(|pointer| pointer.value().to_tag().ok());
        // The stack is already in the list.
        if let Some(tag) = tag.filter(|tag| !OF_PLACES.contains(tag) && *tag != STACK_ID) {
            all.push(index(&format!("index of {tag}"), Key::Number(value)));
        }
    }
    for (group, tag, name) in INDICES {
        all.extend(header.element(group, tag).and_then(Key::of).map(|key| index(name, key)));
    }
    for (tag, name) in VECTORS {
        let value = header.numbers(None, tag).get(frame as usize).copied();
        all.extend(value.map(|value| index(name, Key::Number(value))));
    }
    all
}
