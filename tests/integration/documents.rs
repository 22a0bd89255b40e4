//! The commands of README and documents work as printed.

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

use walpha_base::random::Random;

use crate::common::ok;

/// Documents whose commands need nothing but the files that [`reader_files`] makes.
const DOCUMENTS: [&str; 4] = ["README.md", "docs/tutorials/ct.md", "docs/periodic.md", "docs/wvm.md"];

/// What a reader would bring.
fn reader_files(folder: &Path) {
    ok(folder, &["haar", "sample:ct", "-o", "ct.nii.gz"]);
    let mut random = Random::new(1);
    let mut point = || [0; 3].map(|_| (20.0 * random.unit()).to_string()).join(" ");
    let points: Vec<String> = (0..500).map(|_| point()).collect();
    fs::write(folder.join("foam.xyz"), points.join("\n")).expect("a file");
}

/// The lines of a document's shell blocks that begin with `walpha` or make a folder, without their comments.
fn commands(document: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(document);
    let text = fs::read_to_string(path).expect("a document");
    let mut blocks = text.split("```");
    // Text and blocks take turns.
    blocks.next();
    let shell = blocks.step_by(2).filter_map(|block| block.strip_prefix("sh\n"));
    let is_run = |line: &&str| line.starts_with("walpha ") || line.starts_with("mkdir ");
    let lines = shell.flat_map(str::lines).filter(is_run);
    lines.map(|line| line.split("  #").next().unwrap_or(line).trim().to_owned()).collect()
}

#[test]
fn printed_commands_work() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    reader_files(folder);
    let program = Path::new(env!("CARGO_BIN_EXE_walpha")).parent().expect("its folder");
    let path = env::var("PATH").unwrap_or_default();
    for document in DOCUMENTS {
        let commands = commands(document);
        assert!(commands.len() > 1, "{document} has commands");
        // A folder of DICOM slices is what the tests of the feature dicom read.
        for command in commands.iter().filter(|command| !command.contains(" ct/")) {
            if command.contains("sample:skull") && !crate::common::has_skull() {
                continue;
            }
            let made = Command::new("sh")
                .args(["-ec", command])
                .current_dir(folder)
                .env("PATH", format!("{}:{path}", program.display()))
                .env("HOME", folder)
                .output()
                .expect("a shell");
            let errors = String::from_utf8_lossy(&made.stderr);
            assert!(made.status.success(), "{document}: {command}\n{errors}");
        }
    }
}
