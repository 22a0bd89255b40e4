//! Tests that cannot share a process with others.

use std::any::type_name;
use std::env;
use std::process::Command;

/// Set in the process of one test.
const ALONE: &str = "WALPHA_TEST_ALONE";

/// Runs a closure of a test in a process where no other test runs: the program of tests once more, with
/// the name of this test.
#[track_caller]
pub fn alone<F: FnOnce()>(test: F) {
    if env::var_os(ALONE).is_some() {
        return test();
    }
    // As `integration::module::test::{{closure}}`.
    let path = type_name::<F>();
    let name = path.split_once("::").and_then(|(_, rest)| rest.rsplit_once("::"));
    let (name, _) = name.expect("a closure of a test");
    let mut command = Command::new(env::current_exe().unwrap());
    let output = command.args([name, "--exact"]).env(ALONE, "1").output().unwrap();
    let [told, errors] =
        [output.stdout, output.stderr].map(|b| String::from_utf8_lossy(&b).into_owned());
    assert!(output.status.success(), "{told}{errors}");
    assert!(told.contains("1 passed"), "there is no test {name}: {told}{errors}");
}
