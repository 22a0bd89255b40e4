//! Replaces pictures in a terminal if the command is built without them: there is no option, and none is shown.

use std::convert::Infallible;

use clap::Args;

#[derive(Args, Clone, Copy)]
pub(crate) struct InlineArgs {}

#[expect(clippy::unused_self, reason = "there are no options")]
impl InlineArgs {
    pub(crate) fn is_asked_for(self) -> bool {
        false
    }

    pub(crate) fn protocol(self, _: bool) -> Option<Protocol> {
        None
    }
}

#[derive(Clone, Copy)]
pub(crate) enum Protocol {}

impl Protocol {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "as with pictures")]
    pub(crate) fn encode(self, _: &Infallible) -> Result<Vec<u8>, std::io::Error> {
        match self {}
    }
}
