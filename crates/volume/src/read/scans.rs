//! The scans of a JPEG image, found by its markers.

/// The scans of an image up to its end marker (ITU-T T.81, B.1 and B.2).
pub(super) struct Scans {
    /// Where the data of each scan end.
    pub(super) ends: Vec<usize>,
    /// The number of missing low bits of each coefficient; `None` for a coefficient that is in no scan.
    missing: [Option<u8>; 64],
}

impl Scans {
    /// Finds the scans; `None` for an image without an end.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        let mut scans = Self { ends: Vec::new(), missing: [None; 64] };
        let mut at = 2;
        loop {
            // Decoders skip bytes between segments.
            at += bytes.get(at..)?.windows(2).position(is_marker)?;
            let marker = bytes[at + 1];
            at += 2;
            match marker {
                0xd9 => return Some(scans),
                0x01 | 0xd0..=0xd8 => continue,
                _ => {}
            }
            let length = usize::from(u16::from_be_bytes([*bytes.get(at)?, *bytes.get(at + 1)?]));
            let segment = bytes.get(at..at + length.max(2))?;
            at += segment.len();
            if marker == 0xda {
                let &[.., first, last, bits] = segment else { return None };
                let coefficients = usize::from(first)..=usize::from(last);
                scans.missing.get_mut(coefficients)?.fill(Some(bits & 15));
                let ends = |pair: &[u8]| is_marker(pair) && !(0xd0..=0xd7).contains(&pair[1]);
                at += bytes.get(at..)?.windows(2).position(ends)?;
                scans.ends.push(at);
            }
        }
    }

    /// Whether all bits of all coefficients are there.
    pub(super) fn are_complete(&self) -> bool {
        self.missing.iter().all(|missing| *missing == Some(0))
    }
}

/// Whether two bytes are a marker, and not a data byte 255 or a fill byte.
fn is_marker(pair: &[u8]) -> bool {
    pair[0] == 0xff && pair[1] != 0 && pair[1] != 0xff
}
