//! The meaning of stored pixels: modality tables, padding, bits, floating point.

use walpha::volume::{Dtype, Nan, ReadOptions, read};

use super::{Element, Slice, element, items, open, series, slice};
use crate::common::{Told, fails, json, ok};

fn us(numbers: &[u16]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

/// A Modality LUT of this descriptor and data.
fn table(descriptor: &[u16], data: Vec<u8>) -> Element {
    let item = [element(0x28, 0x3002, b"US", &us(descriptor)), element(0x28, 0x3006, b"OW", &data)];
    (0x28, 0x3000, b"SQ", items(&[item.concat()]))
}

/// Three equal slices with the given pixels and elements, and without a rescale.
fn three(pixels: [i16; 6], changed: impl Fn(i16) -> Vec<Element>) -> Vec<Slice> {
    let none = [(0x28, 0x1052, b"DS", Vec::new()), (0x28, 0x1053, b"DS", Vec::new())];
    let one = |n: i16| {
        let slice = Slice { pixels: pixels.to_vec(), ..slice(n, f64::from(n)) };
        slice.with(none.clone()).with(changed(n))
    };
    (0..3).map(one).collect()
}

#[test]
fn a_modality_table_gives_the_values() {
    let first = |slices: &[Slice]| series(slices).unwrap().as_slice()[..6].to_vec();
    // Entries from the number −2 on; before them holds the first, behind them the last.
    let entries = us(&[1000, 1003, 1006, 1009]);
    let slices = three([-9, -2, -1, 0, 1, 9], |_| vec![table(&[4, 65534, 16], entries.clone())]);
    assert_eq!(first(&slices), [1000.0, 1000.0, 1003.0, 1006.0, 1009.0, 1009.0]);
    assert_eq!(series(&slices).unwrap().dtype(), Dtype::U16);
    // A table of 8 bits, with one entry in each byte or in each word.
    for data in [vec![9, 8, 7, 250], us(&[9, 8, 7, 250])] {
        let slices = three([0, 1, 2, 3, 4, 0], |_| vec![table(&[4, 0, 8], data.clone())]);
        assert_eq!(first(&slices), [9.0, 8.0, 7.0, 250.0, 250.0, 9.0]);
    }
    // A table with more entries than 16 bits can count.
    let all: Vec<u8> = us(&(0..=u16::MAX).collect::<Vec<_>>());
    let slices = three([-32768, 0, 32767, 1, 2, 3], |_| vec![table(&[0, 32768, 16], all.clone())]);
    assert_eq!(first(&slices)[..3], [0.0, 32768.0, 65535.0]);
    // Contradictory elements are refused.
    let both = |slope: &'static str| {
        let rescale = [(0x28, 0x1053, b"DS", slope.into()), (0x28, 0x1052, b"DS", b"0".to_vec())];
        let with = |_| [vec![table(&[4, 0, 16], us(&[1, 2, 3, 4]))], rescale.to_vec()].concat();
        series(&three([0, 1, 2, 3, 4, 5], with))
    };
    assert!(both("2").unwrap_err().contains("states a Modality LUT Sequence (0028,3000), and"));
    assert_eq!(both("1").unwrap().as_slice()[..4], [1.0, 2.0, 3.0, 4.0]);
    let short = three([0; 6], |_| vec![table(&[40, 0, 16], us(&[1, 2, 3, 4]))]);
    assert!(series(&short).unwrap_err().contains("of 40 entries of 16 bits, and 8 bytes"));
    let flat = three([0; 6], |_| vec![(0x28, 0x1053, b"DS", b"0".to_vec())]);
    assert!(series(&flat).unwrap_err().contains("Rescale Slope (0028,1053) 0"));
}

#[test]
fn a_table_may_be_of_a_frame() {
    let own = |first: u16| {
        let (number, _, _, data) = table(&[2, 0, 16], us(&[first, first + 1]));
        element(0x28, 0x9145, b"SQ", &items(&[element(number, 0x3000, b"SQ", &data)]))
    };
    let mut two = super::frames::enhanced(&[0.0, 1.0]);
    two.pixels = vec![0, 1, 0, 1, 0, 1, 1, 1, 1, 0, 0, 0];
    let place = |z: &str| {
        let place = element(0x20, 0x32, b"DS", format!("1\\2\\{z}").as_bytes());
        element(0x20, 0x9113, b"SQ", &items(&[place]))
    };
    let frames = [[place("0"), own(10)].concat(), [place("1"), own(20)].concat()];
    let volume = series(&[two.with([(0x5200, 0x9230, b"SQ", items(&frames))])]).unwrap();
    assert_eq!(volume.as_slice()[..2], [10.0, 11.0]);
    assert_eq!(volume.as_slice()[6..10], [21.0, 21.0, 21.0, 20.0]);
}

#[test]
fn padding_is_masked_and_said() {
    let pixels = [-2000, -5, 3, 40, -2000, 7];
    let padded = |elements: Vec<Element>| series(&three(pixels, |_| elements.clone())).unwrap();
    let value = |n: i16| (0x28, 0x120, b"SS", n.to_le_bytes().to_vec());
    let limit = |n: i16| (0x28, 0x121, b"SS", n.to_le_bytes().to_vec());
    let masked = |elements: Vec<Element>| {
        let volume = padded(elements);
        let missing: Vec<usize> = (0..6).filter(|&i| volume.is_missing(i)).collect();
        // The least of the others stands there.
        let least = (0..6).filter(|&i| !volume.is_missing(i)).map(|i| volume.as_slice()[i]);
        let least = least.fold(f32::INFINITY, f32::min);
        assert!(missing.iter().all(|&i| volume.as_slice()[i] == least));
        missing
    };
    assert_eq!(masked(vec![value(-2000)]), [0, 4]);
    // Either end of a range may come first.
    assert_eq!(masked(vec![value(-2000), limit(-5)]), [0, 1, 4]);
    assert_eq!(masked(vec![value(-5), limit(-2000)]), [0, 1, 4]);
    // Its type may be that of unsigned numbers, although pixels are signed.
    let unsigned = (0x28, 0x120, b"US", (-2000i16).to_le_bytes().to_vec());
    assert_eq!(masked(vec![unsigned]), [0, 4]);
    assert!(!padded(vec![]).has_missing() && !padded(vec![limit(3)]).has_missing());
    // It is compared with stored values, not with their meaning.
    let rescaled = vec![value(3), (0x28, 0x1052, b"DS", b"-3".to_vec())];
    assert_eq!(masked(rescaled), [2]);
    // Beyond the bits that are stored, all bits are compared.
    let bits = |n: u16| (0x28, 0x101, b"US", us(&[n]));
    let high = (0x28, 0x102, b"US", us(&[11]));
    assert_eq!(masked(vec![value(-2000), bits(12), high]), [0, 4]);
    let text = series(&three([7; 6], |_| vec![value(7)])).unwrap_err();
    assert!(
        text.contains("holds nothing but padding (Pixel Padding Value 7): 18 samples"),
        "{text}"
    );
}

#[test]
fn padding_is_told_and_can_be_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let padding = |_| vec![(0x28, 0x120, b"SS", (-2000i16).to_le_bytes().to_vec())];
    for (n, slice) in three([-2000, -5, 3, 40, -2000, 7], padding).iter().enumerate() {
        slice.save(f, &format!("{n}.dcm"));
    }
    let told = json(f, &["info", "."]);
    assert_eq!(
        (&told["missing"], &told["min"], &told["samples"]),
        (&6.into(), &(-5.0).into(), &"i16".into())
    );
    let warned = told["warnings"].to_string();
    assert!(warned.contains("6 samples of padding (Pixel Padding Value -2000)"), "{warned}");
    assert!(ok(f, &["info", "."]).contains("missing   6 samples are padding, and masked"));
    let replaced = read(f, &ReadOptions::default().nan(Some(Nan::Value(-100.0)))).unwrap();
    assert_eq!((replaced.as_slice()[0], replaced.has_missing()), (-100.0, false));
    // Points are not made of it, and what is converted says it.
    let points = json(f, &["points", ".", "--count", "12", "--rms", "0", "-o", "p.npy"]);
    assert_eq!(points["points"]["selected"], 12, "{points}");
    fails(f, 1, "points . --count 13 --rms 0 -o q.npy", &["13 points cannot be selected"]);
}

/// A format that knows no padding gets NaN.
#[cfg(feature = "zarr")]
#[test]
fn padding_is_converted_to_nan() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let padding = |_| vec![(0x28, 0x120, b"SS", (-2000i16).to_le_bytes().to_vec())];
    std::fs::create_dir(f.join("ct")).unwrap();
    for (n, slice) in three([-2000, -5, 3, 40, -2000, 7], padding).iter().enumerate() {
        slice.save(&f.join("ct"), &format!("{n}.dcm"));
    }
    let told = json(f, &["convert", "ct", "-o", "ct.zarr"]);
    assert!(
        told["warnings"]
            .to_string()
            .contains("6 samples of padding, or not finite, written as NaN"),
        "{told}"
    );
    let told = json(f, &["info", "ct.zarr"]);
    assert_eq!((&told["missing"], &told["samples"]), (&6.into(), &"f32".into()), "{told}");
}

/// Air around a ball of water with bone in it, in a circle of reconstruction that padding surrounds.
#[test]
fn padding_does_not_hide_hounsfield_units() {
    let of = |outside: i16, elements: Vec<Element>| {
        let folder = tempfile::tempdir().unwrap();
        for n in 0..12i16 {
            let pixel = |i: i16| {
                let at = [2 * (i % 24) - 23, 2 * (i / 24) - 23, 4 * n - 22];
                let [flat, round] = [&at[..2], &at].map(|at| at.iter().map(|v| v * v).sum::<i16>());
                match (flat, round) {
                    (484.., _) => outside,
                    (_, ..100) => 900,
                    (_, ..200) => 40,
                    _ => -1000 + i % 3,
                }
            };
            let sizes = [(0x28, 0x10, b"US", us(&[24])), (0x28, 0x11, b"US", us(&[24]))];
            let slice = Slice { pixels: (0..576).map(pixel).collect(), ..slice(n, f64::from(n)) };
            slice.with(sizes).with(elements.clone()).save(folder.path(), &format!("{n}.dcm"));
        }
        let told = json(folder.path(), &["info", "."]);
        let shape = json(folder.path(), &["shape", ".", "-o", "s.ply", "--count", "300"]);
        (told["preset"].clone(), shape["shape"].clone())
    };
    let plain = of(-1000, vec![]);
    assert!(plain.0.is_string());
    for value in [-2000_i16, -3024, -32768] {
        let padding = (0x28, 0x120, b"SS", value.to_le_bytes().to_vec());
        let padded = of(value, vec![padding]);
        assert_eq!(padded.0, plain.0, "{value}");
        assert_eq!(padded.1["betti"], plain.1["betti"], "{value}: {}", padded.1);
    }
}

#[test]
fn only_the_stored_bits_count() {
    let number = |n: u16| us(&[n]);
    let bits = |stored, high, signed| {
        vec![
            (0x28, 0x101, b"US", number(stored)),
            (0x28, 0x102, b"US", number(high)),
            (0x28, 0x103, b"US", number(signed)),
        ]
    };
    let first = |pixels: [i16; 6], elements: Vec<Element>| {
        series(&three(pixels, |_| elements.clone())).unwrap().as_slice()[..3].to_vec()
    };
    // Twelve bits at the upper end of a word, below others, and signed.
    assert_eq!(first([0x10, 0x7ff0, -16, 0, 0, 0], bits(12, 15, 0)), [1.0, 2047.0, 4095.0]);
    assert_eq!(
        first([0x1001, 0x7fff_u16 as i16, -1, 0, 0, 0], bits(12, 11, 0)),
        [1.0, 4095.0, 4095.0]
    );
    assert_eq!(first([0x0fff, 0x0800, 0x07ff, 0, 0, 0], bits(12, 11, 1)), [-1.0, -2048.0, 2047.0]);
    let text = series(&three([0; 6], |_| bits(12, 3, 0))).unwrap_err();
    assert!(text.contains("and bit 3 as the highest"), "{text}");
}

#[test]
fn pixels_may_be_of_floating_point() {
    let floats = |bits: u16, pixels: Element, others: Vec<Element>| {
        let number = |number| (0x28, number, b"US", Vec::new());
        let own = [(0x28, 0x100, b"US", us(&[bits])), number(0x101), number(0x102), number(0x103)];
        let of = |_| {
            [own.to_vec(), vec![(0x7fe0, 0x10, b"OW", Vec::new()), pixels.clone()], others.clone()]
                .concat()
        };
        series(&three([0; 6], of)).unwrap()
    };
    let values = [0.5, -3.25, 1e10, 7.0, -3.25, 0.0];
    let single: Vec<u8> = values.iter().flat_map(|&v| (v as f32).to_le_bytes()).collect();
    let double: Vec<u8> = values.iter().flat_map(|v: &f64| v.to_le_bytes()).collect();
    let expected: Vec<f32> = values.iter().map(|&v| v as f32).collect();
    let volume = floats(32, (0x7fe0, 8, b"OF", single.clone()), vec![]);
    assert_eq!((&volume.as_slice()[..6], volume.dtype()), (&expected[..], Dtype::F32));
    let padding = (0x28, 0x122, b"FL", (-3.25f32).to_le_bytes().to_vec());
    let volume = floats(32, (0x7fe0, 8, b"OF", single), vec![padding]);
    assert!(volume.is_missing(1) && volume.is_missing(4) && volume.samples_there() == 12);
    let padding = (0x28, 0x123, b"FD", 7f64.to_le_bytes().to_vec());
    let limit = (0x28, 0x125, b"FD", 2e10f64.to_le_bytes().to_vec());
    let volume = floats(64, (0x7fe0, 9, b"OD", double), vec![padding, limit]);
    assert_eq!((volume.dtype(), volume.as_slice()[0]), (Dtype::F64, 0.5));
    assert_eq!((0..6).filter(|&i| volume.is_missing(i)).collect::<Vec<_>>(), [2, 3]);
}

#[test]
fn what_is_shown_otherwise_keeps_its_values() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let shown = |name: &'static [u8]| move |_| vec![(0x28, 4, b"CS", name.to_vec())];
    let save = |slices: Vec<Slice>| {
        slices.iter().enumerate().for_each(|(n, slice)| slice.save(f, &format!("{n}.dcm")));
    };
    save(three([5, 4, 3, 2, 1, 0], shown(b"MONOCHROME1")));
    assert_eq!(open(f).unwrap().as_slice()[..3], [5.0, 4.0, 3.0]);
    let warned = json(f, &["info", "."])["warnings"].to_string();
    assert!(warned.contains("is MONOCHROME1") && warned.contains("(3 files are so)"), "{warned}");
    save(three([5, 4, 3, 2, 1, 0], shown(b"PALETTE COLOR")));
    let text = open(f).unwrap_err().told();
    assert!(text.contains("numbers of colours in a palette (PALETTE COLOR)"), "{text}");
}

/// Pixels of an icon come before those of the image.
#[test]
fn an_icon_is_not_the_image() {
    let icon = [element(0x28, 0x10, b"US", &us(&[2])), element(0x7fe0, 0x10, b"OW", &[0; 4])];
    let icon = (0x88, 0x200, b"SQ", items(&[icon.concat()]));
    let volume = series(&[slice(1, 0.0).with([icon])]).unwrap();
    assert_eq!(volume.as_slice(), [10.0, 11.0, 12.0, 13.0, 14.0, 15.0]);
    let twice = Slice { pixels: (0..12).collect(), ..slice(1, 0.0) };
    let text = series(&[twice]).unwrap_err();
    assert!(
        text.contains("claims 1 × 3×2 pixels, which are 12 bytes, and 24 bytes of them"),
        "{text}"
    );
}
