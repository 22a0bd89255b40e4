use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use walpha_base::shown::shown;

use crate::unfinished::Temporary;

/// A temporary file with a name. It is removed when this is dropped, and also when the process is interrupted.
#[derive(Debug)]
pub struct Scratch {
    temporary: Temporary,
}

impl Scratch {
    /// Copies everything from a reader to a file whose name ends with `ending`, in the system's folder for
    /// temporary files.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn of(reader: &mut dyn Read, ending: &str) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix("walpha-").suffix(ending);
        let folder = std::env::temp_dir();
        let made = Temporary::make(&builder, &folder, |path| File::create_new(path));
        let (mut file, temporary) = made.map_err(|error| {
            let what = format!("no file can be made in {}: {error}", shown(&folder));
            io::Error::new(error.kind(), what)
        })?;
        io::copy(reader, &mut file)?;
        Ok(Self { temporary })
    }

    /// The path of the file.
    #[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
    pub fn path(&self) -> &Path {
        self.temporary.path().expect("it is never taken")
    }
}
