use std::path::Path;

use dicom_object::mem::InMemElement;
use dicom_object::{InMemDicomObject, Tag};

use crate::read::format_error;
use crate::{Reason, VolumeError};

const SHARED_FUNCTIONAL_GROUPS: Tag = Tag(0x5200, 0x9229);
const PER_FRAME_FUNCTIONAL_GROUPS: Tag = Tag(0x5200, 0x9230);

/// The header of a file, as it applies to one of its frames: in enhanced images some elements are in
/// functional groups, of the frame or shared by all frames (PS3.3, C.7.6.16).
#[derive(Clone, Copy)]
pub(super) struct Header<'a> {
    path: &'a Path,
    object: &'a InMemDicomObject,
    frame: Option<u32>,
}

impl<'a> Header<'a> {
    /// Of a file.
    pub(super) fn new(path: &'a Path, object: &'a InMemDicomObject) -> Self {
        Self { path, object, frame: None }
    }

    /// As the frame has it that is counted from 0.
    pub(super) fn of_frame(self, frame: u32) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// The functional groups that hold for the frame, its own first.
    fn groups(&self) -> impl Iterator<Item = &'a InMemDicomObject> {
        let items = |tag: Tag| self.object.get(tag).and_then(|sequence| sequence.items());
        let own = self.frame.and_then(|frame| {
            items(PER_FRAME_FUNCTIONAL_GROUPS).and_then(|items| items.get(frame as usize))
        });
        own.into_iter().chain(items(SHARED_FUNCTIONAL_GROUPS).and_then(|items| items.first()))
    }

    /// An element, from the functional group `group` where there is one.
    fn element(&self, group: Option<Tag>, tag: Tag) -> Option<&'a InMemElement> {
        let in_group = |all: &'a InMemDicomObject| {
            all.get(group?)?.items().and_then(|items| items.first())?.get(tag)
        };
        self.groups().find_map(in_group).or_else(|| self.object.get(tag))
    }

    /// A number, if it is there.
    pub(super) fn number(
        &self,
        group: impl Into<Option<Tag>>,
        tag: Tag,
    ) -> Result<Option<f64>, VolumeError> {
        let Some(element) = self.element(group.into(), tag) else { return Ok(None) };
        if element.value().multiplicity() == 0 {
            return Ok(None);
        }
        let number = element.to_float64().ok().filter(|number| number.is_finite());
        number.map(Some).ok_or_else(|| {
            format_error(
                self.path,
                Reason::damaged(format!("has no number at {tag}: it is damaged")),
            )
        })
    }

    /// `N` numbers, called `name`, which a volume needs because of `why`.
    pub(super) fn vector<const N: usize>(
        &self,
        group: Tag,
        tag: Tag,
        name: &str,
        why: &str,
    ) -> Result<[f64; N], VolumeError> {
        let element = self.element(group.into(), tag);
        let numbers = element.and_then(|element| element.to_multi_float64().ok());
        let numbers = numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
        numbers.filter(|numbers| numbers.iter().all(|number| number.is_finite())).ok_or_else(|| {
            format_error(
                self.path,
                Reason::header(format!("has no {name} {tag} of {N} numbers, {why}")),
            )
        })
    }
}
