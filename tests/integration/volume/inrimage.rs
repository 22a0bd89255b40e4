//! INRIMAGE.

use super::*;

#[test]
fn inrimages_of_every_type_and_order() {
    let folder = Folder::new();
    for dtype in Dtype::ALL {
        for (endian, cpu) in [
            (Endian::Little, "decm"),
            (Endian::Little, "alpha"),
            (Endian::Little, "pc"),
            (Endian::Big, "sun"),
            (Endian::Big, "sgi"),
        ] {
            let (payload, expected) = three(dtype, endian);
            let kind = match dtype.name().as_bytes()[0] {
                b'f' => "float",
                b'u' => "unsigned fixed",
                _ => "signed fixed",
            };
            let bits = 8 * dtype.size();
            let header = format!(
                "XDIM=1\nYDIM=3\nZDIM=1\nVDIM=1\nTYPE={kind}\nPIXSIZE={bits} bits\nSCALE=2**0\n\
                 CPU={cpu}\nVX=0.5\nVY=2\nVZ=3.25\nTX=-1\n# a remark"
            );
            let bytes = inr(&header, &payload);
            for (name, bytes) in
                [("v.inr", bytes.clone()), ("v.inr.gz", gzip(&bytes)), ("v", bytes)]
            {
                let volume = read(&folder.file(name, &bytes), &known()).unwrap();
                assert_eq!(volume.as_slice(), expected, "{dtype} {cpu} {name}");
                assert_eq!(volume.dims().xyz(), [1, 3, 1]);
                assert_eq!(volume.frame().spacing, [0.5, 2.0, 3.25]);
                assert_eq!(volume.frame().origin, [-1.0, 0.0, 0.0]);
                assert_eq!(volume.has_gray_levels(), dtype == Dtype::U8);
            }
        }
    }
}

#[test]
fn long_inrimage_headers_are_read() {
    let header = format!(
        "XDIM=1\nYDIM=1\nZDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=pc\n#{}",
        "-".repeat(700)
    );
    let bytes = inr(&header, &2.5f32.to_le_bytes());
    assert_eq!(bytes.len(), 4 * 256 + 4, "four blocks");
    let volume = read(&Folder::new().file("v.inr", &bytes), &known());
    assert_eq!(volume.unwrap().as_slice(), [2.5]);
}

/// Some writers pad to other lengths than multiples of 256, or not at all; CGAL reads them, too.
#[test]
fn inrimage_headers_of_any_length_are_read() {
    let lines = "XDIM=1\nYDIM=1\nZDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=pc\n";
    for padding in [0, 1, 100, 255, 256, 700] {
        let header = format!("#INRIMAGE-4#{{\n{lines}{}##}}\n", "\n".repeat(padding));
        let bytes = [header.as_bytes(), &2.5f32.to_le_bytes()].concat();
        let volume = read(&Folder::new().file("v.inr", &bytes), &known());
        assert_eq!(volume.unwrap().as_slice(), [2.5], "{padding}");
    }
}

#[test]
fn damaged_inrimages_are_refused() {
    let folder = Folder::new();
    let refuses = |bytes: &[u8], parts: &[&str]| folder.refuses("v.inr", bytes, &known(), parts);
    let good = "XDIM=3\nYDIM=1\nZDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=decm\n";
    let payload = [0; 12];
    assert!(read(&folder.file("v.inr", &inr(good, &payload)), &known()).is_ok());

    refuses(b"", &["is empty"]);
    refuses(b"hello", &["not an INRIMAGE"]);
    refuses(&inr(good, &payload)[..200], &["truncated"]);
    refuses(&inr(good, &payload[..11]), &["3×1×1", "12 bytes", "11", "truncated"]);
    refuses(&inr(good, &[0; 13]), &["12 bytes", "13", "too long"]);
    refuses(&inr(&good.replace("XDIM=3\n", ""), &payload), &["no XDIM"]);
    refuses(&inr(&good.replace("XDIM=3", "XDIM=0"), &payload), &["0×1×1", "empty"]);
    refuses(&inr(&good.replace("XDIM=3", "XDIM=-3"), &payload), &["XDIM=-3"]);
    refuses(&inr(&good.replace("=32 bits", "=24 bits"), &payload), &["PIXSIZE=24"]);
    refuses(&inr(&good.replace("decm", "vax"), &payload), &["CPU=vax"]);
    refuses(&inr(&good.replace("CPU=decm\n", ""), &payload), &["CPU=(missing)"]);
    refuses(&inr(&format!("{good}VDIM=3"), &payload), &["3 values a voxel"]);
    refuses(&inr(&format!("{good}RX=0.5"), &payload), &["RX"]);
    refuses(&inr(&format!("{good}VX=0"), &payload), &["VX", "positive"]);
    refuses(&inr(&format!("{good}VX=nan"), &payload), &["VX=nan"]);
    let nan = [1f32, 2.0, f32::NAN].map(f32::to_le_bytes).concat();
    refuses(&inr(good, &nan), &["[2, 0, 0]", "NaN"]);
    let endless = [inr(good, &[])[..252].to_vec(), vec![b'\n'; 20_000]].concat();
    refuses(&endless, &["no end of header"]);
}
