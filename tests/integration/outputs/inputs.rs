//! What is read is not written over.

use super::*;

const IS_INPUT: [&str; 3] =
    ["it is an input, which would be lost", "another destination", "--in-place"];

fn points(folder: &Path, name: &str) -> std::path::PathBuf {
    let path = folder.join(name);
    fs::write(&path, "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n").unwrap();
    path
}

#[test]
fn an_input_is_not_replaced_under_any_of_its_names() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let input = points(f, "in.csv");
    let before = fs::read(&input).unwrap();
    symlink("in.csv", f.join("link.csv")).unwrap();
    fs::hard_link(&input, f.join("hard.csv")).unwrap();
    fs::create_dir(f.join("sub")).unwrap();
    for output in ["in.csv", "./in.csv", "sub/../in.csv", "link.csv", "hard.csv"] {
        refused(f, &format!("points in.csv -o {output}"), &IS_INPUT);
        refused(f, &format!("points link.csv -o {output}"), &IS_INPUT);
    }
    fs::write(f.join("in.npy"), "what is in it does not matter").unwrap();
    refused(f, "interpolate in.npy -o a.npy --mask in.npy", &IS_INPUT);
    assert_eq!(fs::read(&input).unwrap(), before);
    ok(f, &["points", "in.csv", "-o", "other.csv"]);
    ok(f, &["points", "in.csv", "-o", "in.csv", "--in-place"]);
    assert_ne!(fs::read(&input).unwrap(), before);
    let word = ["--in-place has no effect", "writes no file"];
    refused_as(2, f, "info in.csv --in-place", &word);
}

#[test]
fn the_data_file_of_a_header_is_an_input() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let header = "NRRD0004\ntype: float\ndimension: 3\nsizes: 8 8 8\nendian: little\n\
                  encoding: raw\ndata file: d.raw\n";
    fs::write(f.join("d.nhdr"), header).unwrap();
    let samples: Vec<u8> = (0..512).flat_map(|i| (i as f32).to_le_bytes()).collect();
    fs::write(f.join("d.raw"), &samples).unwrap();
    symlink("d.raw", f.join("link.raw")).unwrap();
    for output in ["d.raw", "link.raw"] {
        refused(f, &format!("haar d.nhdr -o {output}"), &IS_INPUT);
    }
    assert_eq!(fs::read(f.join("d.raw")).unwrap(), samples);
    ok(f, &["haar", "d.nhdr", "-o", "d.raw", "--in-place"]);
}

/// The slices of a folder are inputs; other files in it are not.
#[cfg(feature = "render")]
#[test]
fn slices_are_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::create_dir(f.join("slices")).unwrap();
    for i in 0..6 {
        fs::write(f.join(format!("slices/{i}.png")), "a slice").unwrap();
    }
    refused(f, "shape slices --count 100 -o slices/3.png", &IS_INPUT);
    fs::write(f.join("slices/a.ply"), "old").unwrap();
    let args = "shape slices --count 100 -o slices/a.ply";
    let (_, _, said) = run(f, &args.split(' ').collect::<Vec<_>>());
    assert!(!said.contains("it is an input"), "{said}");
}

#[test]
fn the_folder_of_a_plan_is_for_its_files_alone() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    ok(f, &["haar", "sample:phantom@20", "-o", "in.npy"]);
    ok(f, &["blocks", "plan", "in.npy", "--blocks", "3", "-o", "work"]);
    ok(f, &["blocks", "run", "work"]);
    symlink("work", f.join("link")).unwrap();
    let plan = fs::read(f.join("work/plan.json")).unwrap();
    let word = ["it is in the working folder of a plan", "another destination", "--in-place"];
    for output in
        ["work/plan.json", "work/new.json", "link/plan.json", "work/new.pvtu", "work.pvtu"]
    {
        refused(f, &format!("blocks merge work -o {output}"), &word);
        refused(f, &format!("blocks merge work -o a.ply {output}"), &word);
    }
    symlink("in.npy", f.join("in.ply")).unwrap();
    refused(f, "blocks merge work -o in.ply", &IS_INPUT);
    assert_eq!(fs::read(f.join("work/plan.json")).unwrap(), plan);
    ok(f, &["blocks", "check", "work"]);
    ok(f, &["blocks", "merge", "work", "-o", "a.ply", "b.pvtu"]);
    fs::create_dir(f.join("c.blocks")).unwrap();
    refused(f, "shape in.npy -o c.pvtu c.blocks/a.ply", &word);
    ok(f, &["blocks", "merge", "work", "-o", "work/new.json", "--in-place"]);
}
