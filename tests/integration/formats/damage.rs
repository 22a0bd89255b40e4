use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use proptest::prelude::*;
use walpha::points::read_points;

use super::files::*;
use crate::common::alone::alone;
use crate::common::largest::largest;

proptest! {
    // A smaller example of what hangs is not worth minutes.
    #![proptest_config(ProptestConfig { cases: 4000, max_shrink_time: 30_000, ..ProptestConfig::default() })]

    fn damage_does_no_harm(
        which in any::<prop::sample::Index>(),
        edits in prop::collection::vec(
            (any::<prop::sample::Index>(), prop_oneof![any::<u8>(), b'0'..=b'9', Just(0), Just(0xff)]),
            0..5,
        ),
        // Headers are where damage matters most.
        in_head in any::<bool>(),
        keep in prop::option::weighted(0.2, any::<prop::sample::Index>()),
    ) {
        let volumes = examples();
        let files = [&volumes[..], &point_examples()[..]].concat();
        let (name, mut bytes) = which.get(&files).clone();
        for (place, value) in edits {
            let length = if in_head { bytes.len().min(400) } else { bytes.len() };
            bytes[place.index(length)] = value;
        }
        if let Some(keep) = keep {
            bytes.truncate(keep.index(bytes.len()));
        }
        let folder = tempfile::tempdir().unwrap();
        let path = save(folder.path(), name, bytes);
        let (done, wait) = channel();
        let reader = thread::spawn(move || {
            let _ = open(&path);
            let _ = walpha::points::is_point_file(&path);
            let _ = read_points(&path, None);
            let _ = done.send(());
        });
        // A reader that hangs stays behind; one that panics sends nothing, and is told by its join.
        let waited = wait.recv_timeout(Duration::from_secs(10));
        prop_assert!(waited != Err(RecvTimeoutError::Timeout), "{name} hangs");
        prop_assert!(reader.join().is_ok(), "{name} makes the reader panic");
        let largest = largest();
        prop_assert!(largest < 1 << 30, "{name} asks for {largest} bytes");
    }
}

/// Bytes changed anywhere and files cut anywhere make errors or other numbers: no panic, no
/// hang, and no allocation beyond what the file can hold.
#[test]
fn no_damage_does_harm() {
    alone(|| {
        damage_does_no_harm();
    });
}
