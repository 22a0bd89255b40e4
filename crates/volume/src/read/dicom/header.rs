//! The header of a file, as it applies to one of its frames.

use std::path::Path;

use dicom_object::mem::InMemElement;
use dicom_object::{InMemDicomObject, Tag};

use crate::error::format_error;
use crate::{Reason, VolumeError};

const SHARED_FUNCTIONAL_GROUPS: Tag = Tag(0x5200, 0x9229);
const PER_FRAME_FUNCTIONAL_GROUPS: Tag = Tag(0x5200, 0x9230);
const DETECTOR_INFORMATION: Tag = Tag(0x0054, 0x0022);

/// The header of a file, as it applies to one of its frames: in enhanced images some elements are in functional groups, of the
/// frame or shared by all frames (PS3.3, C.7.6.16), and in nuclear medicine they are with the detector.
#[derive(Clone, Copy)]
pub(super) struct Header<'a> {
    path: &'a Path,
    object: &'a InMemDicomObject,
    frame: Option<u32>,
}

impl<'a> Header<'a> {
    /// The header of a whole file.
    pub(super) fn new(path: &'a Path, object: &'a InMemDicomObject) -> Self {
        Self { path, object, frame: None }
    }

    /// The header as it applies to the frame with this number, from 0.
    pub(super) fn of_frame(self, frame: u32) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// An error about the file.
    pub(super) fn fail(&self, reason: Reason) -> VolumeError {
        format_error(self.path, reason)
    }

    /// The functional groups that apply to the frame, its own first.
    fn groups(&self) -> impl Iterator<Item = &'a InMemDicomObject> {
        let items = |tag: Tag| self.object.get(tag).and_then(|sequence| sequence.items());
        let own = self.frame.and_then(|frame| {
            items(PER_FRAME_FUNCTIONAL_GROUPS).and_then(|items| items.get(frame as usize))
        });
        own.into_iter().chain(items(SHARED_FUNCTIONAL_GROUPS).and_then(|items| items.first()))
    }

    /// An element, from the functional group `group` if it is there.
    pub(super) fn element(
        &self,
        group: impl Into<Option<Tag>>,
        tag: Tag,
    ) -> Option<&'a InMemElement> {
        let group = group.into();
        let first = |all: &'a InMemDicomObject, group| all.get(group)?.items()?.first();
        let in_group = |all: &'a InMemDicomObject| first(all, group?)?.get(tag);
        let filled = |element: &&InMemElement| !element.value().multiplicity().eq(&0);
        let own = || self.object.get(tag).filter(filled);
        let of_detector = || first(self.object, DETECTOR_INFORMATION)?.get(tag);
        self.groups().find_map(in_group).or_else(own).or_else(of_detector)
    }

    /// The items of a sequence, from the functional group if it is there.
    pub(super) fn items(
        &self,
        group: impl Into<Option<Tag>>,
        tag: Tag,
    ) -> Option<&'a [InMemDicomObject]> {
        self.element(group, tag)?.items().filter(|items| !items.is_empty())
    }

    /// Whether the file or a functional group of the frame has an element.
    pub(super) fn has(&self, tag: Tag) -> bool {
        self.object.get(tag).is_some() || self.groups().any(|group| group.get(tag).is_some())
    }

    /// A text, if it exists, without padding.
    pub(super) fn text(&self, group: impl Into<Option<Tag>>, tag: Tag) -> Option<String> {
        let text = self.element(group, tag)?.to_str().ok()?;
        Some(text.trim_matches(['\0', ' ']).to_owned()).filter(|text| !text.is_empty())
    }

    /// A number, if it exists.
    pub(super) fn number(
        &self,
        group: impl Into<Option<Tag>>,
        tag: Tag,
    ) -> Result<Option<f64>, VolumeError> {
        let Some(element) = self.element(group, tag) else { return Ok(None) };
        if element.value().multiplicity() == 0 {
            return Ok(None);
        }
        let number = element.to_float64().ok().filter(|number| number.is_finite());
        let wrong = || {
            self.fail(Reason::header(format!(
                "has {} at {tag}, which is not a number",
                shown(element)
            )))
        };
        number.map(Some).ok_or_else(wrong)
    }

    /// A number, or `other` if it does not exist.
    pub(super) fn number_or(&self, tag: Tag, other: f64) -> Result<f64, VolumeError> {
        Ok(self.number(None, tag)?.unwrap_or(other))
    }

    /// All numbers of an element; none if it does not exist.
    pub(super) fn numbers(&self, group: impl Into<Option<Tag>>, tag: Tag) -> Vec<f64> {
        let element = self.element(group, tag);
        element.and_then(|element| element.to_multi_float64().ok()).unwrap_or_default()
    }

    /// `N` numbers, called `name`, that every slice of a volume needs. If they are missing, the error advises `next`.
    pub(super) fn vector<const N: usize>(
        &self,
        group: Tag,
        tag: Tag,
        name: &str,
        next: &str,
    ) -> Result<[f64; N], VolumeError> {
        let numbers = <[f64; N]>::try_from(self.numbers(group, tag)).ok();
        numbers.filter(|numbers| numbers.iter().all(|number| number.is_finite())).ok_or_else(|| {
            match self.element(group, tag) {
                Some(element) if element.value().multiplicity() > 0 => self.fail(Reason::header(
                    format!("has {name} {tag} {}, which is not {N} numbers", shown(element)),
                )),
                _ => self.fail(Reason::content(
                    format!("has no {name} {tag}, which a slice of a volume needs"),
                    next.to_owned(),
                )),
            }
        })
    }
}

/// A value for messages.
fn shown(element: &InMemElement) -> String {
    element.to_str().map_or_else(|_| "a value".into(), |text| format!("{:?}", text.trim()))
}
