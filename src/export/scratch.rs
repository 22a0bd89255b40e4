use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use tempfile::TempPath;

use super::unfinished::{Entry, gate};

/// A file with a name for a while, which goes when it is dropped, and also when the process is
/// interrupted.
#[derive(Debug)]
pub struct Scratch {
    temporary: Option<TempPath>,
    entry: &'static Entry,
}

impl Scratch {
    /// Everything that a reader has, in a file whose name ends with `ending`, in the system's folder for
    /// such files.
    ///
    /// # Errors
    /// What the system said.
    pub fn of(reader: &mut dyn Read, ending: &str) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix("walpha-").suffix(ending);
        let mut gate = gate();
        let mut entry = None;
        // Entered before it is there, so that no signal finds it unknown.
        let made = builder.make_in(std::env::temp_dir(), |path| {
            let entered = gate.enter(path, false)?;
            let file = File::create_new(path).inspect_err(|_| entered.strike())?;
            entry = Some(entered);
            Ok(file)
        });
        let (mut file, temporary) = made?.into_parts();
        drop(gate);
        let entry = entry.expect("entered before it was made");
        let scratch = Self { temporary: Some(temporary), entry };
        io::copy(reader, &mut file)?;
        Ok(scratch)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.temporary.as_deref().expect("only a drop takes it")
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _gate = gate();
        self.temporary = None;
        self.entry.strike();
    }
}
