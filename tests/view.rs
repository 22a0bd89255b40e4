//! The page of `walpha view`: self-contained, whole, and safe whatever its input is called. What it
//! looks like in a browser, `scripts/check_view.py` checks.

mod common;

use std::fs;

use common::{json, ok, run};
use serde_json::Value;

/// The text of the element with this id.
fn element<'a>(html: &'a str, id: &str) -> &'a str {
    let start = html.find(&format!("id=\"{id}\"")).expect("an element of that name");
    let start = start + html[start..].find('>').expect("its end") + 1;
    &html[start..start + html[start..].find("</script>").expect("a script")]
}

fn bytes(array: &Value) -> Vec<u8> {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let text = array["base64"].as_str().unwrap().trim_end_matches('=');
    let (mut bits, mut count, mut bytes) = (0u32, 0, Vec::new());
    for letter in text.bytes() {
        let value = LETTERS.iter().position(|&l| l == letter).expect("base64") as u32;
        (bits, count) = (bits << 6 | value, count + 6);
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    bytes
}

/// How many rows of three levels have this class at a level: 2 regular, 3 singular.
fn count(spans: &[u8], level: u8, class: u8) -> usize {
    let of = |span: &&[u8]| match class {
        2 => (span[1]..span[2]).contains(&level),
        _ => (span[0]..span[1]).contains(&level),
    };
    spans.chunks(3).filter(of).count()
}

#[test]
fn the_page_holds_every_level() {
    let folder = tempfile::tempdir().unwrap();
    let made = json(
        folder.path(),
        &[
            "view",
            "sample:phantom@24",
            "--weights",
            "min-max",
            "--alphas",
            "1,2,5,10,inf",
            "-o",
            "page.html",
            "-q",
        ],
    );
    let html = fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert_eq!(made["bytes"], html.len());
    assert_eq!((&made["levels"], &made["simplified"]), (&Value::from(5), &Value::Null));
    assert!(html.contains("width=device-width"));
    // Plain scripts, no address to load anything from.
    for tag in ["<script src", "<link", "<img", "@import", "cdn.plot.ly/plotly"] {
        assert!(!html.contains(tag), "{tag}");
    }
    let data: Value = serde_json::from_str(element(&html, "data")).unwrap();
    let plot: Value = serde_json::from_str(element(&html, "plot")).unwrap();
    assert_eq!(plot["data"].as_array().unwrap().len(), 5, "with the isosurface");
    assert_eq!(data["levels"].as_array().unwrap().len(), 5);
    let arrays = &data["arrays"];
    let points = made["points"].as_u64().unwrap() as usize;
    assert_eq!(bytes(&arrays["x"]).len(), 4 * points);
    assert_eq!(bytes(&arrays["weights"]).len(), 4 * points);
    let facets = bytes(&arrays["facetSpans"]);
    assert_eq!(bytes(&arrays["facets"]).len(), 4 * facets.len());
    for (k, alpha) in ["1", "2", "5", "10", "inf"].iter().enumerate() {
        // The same as the shapes that the ladder measures, which other tests hold against `shape`.
        let rows = data["levels"][k]["rows"].as_array().unwrap();
        let told = rows.iter().find(|row| row[0] == "facets").unwrap()[1].as_str().unwrap();
        let [regular, singular] = [2, 3].map(|class| count(&facets, k as u8, class));
        assert!(
            told.ends_with(&format!(" {regular} regular, {singular} singular")),
            "α = {alpha}: {told}"
        );
        assert!(regular > 0);
    }
}

#[test]
fn the_same_input_gives_the_same_page_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    for threads in ["1", "3"] {
        let name = format!("{threads}.html");
        ok(folder.path(), &["view", "sample:phantom@20", "-o", &name, "-q", "--threads", threads]);
    }
    let page =
        |threads: &str| fs::read(folder.path().join(threads).with_extension("html")).unwrap();
    assert!(page("1") == page("3"));
}

#[test]
fn names_cannot_break_out_of_the_page() {
    let folder = tempfile::tempdir().unwrap();
    let name = "<script>alert(1)</script>&\".csv";
    // A slash cannot be in a file's name.
    let name = name.replace('/', "\u{2215}");
    let corners =
        (0..9).map(|i| format!("{},{},{},{i}\n", i & 1, i >> 1 & 1, (i >> 2) * (1 + i / 8)));
    let text = "x,y,z,value\n".to_owned() + &corners.collect::<String>();
    fs::write(folder.path().join(&name), text).unwrap();
    let (code, _, stderr) = run(folder.path(), &["view", &name, "-o", "page.html"]);
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.contains("page.html takes "), "its size is told: {stderr}");
    let html = fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(!html.contains("<script>alert"));
    assert!(html.contains("&lt;script&gt;alert(1)"));
    assert!(!element(&html, "plot").contains('<') && !element(&html, "data").contains('<'));
}

#[test]
fn bad_wishes_are_refused_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let levels: Vec<String> = (0..260).map(|k| k.to_string()).collect();
    for (args, word) in [
        (&["view", "sample:phantom@16", "-o", "page.htm"][..], ".html"),
        (&["view", "sample:phantom@16", "-o", "page.html", "--isovalue", "nan"], "--isovalue"),
        (
            &["view", "sample:phantom@16", "-o", "page.html", "--alphas", &levels.join(",")],
            "at most 250",
        ),
    ] {
        let (code, _, stderr) = run(folder.path(), args);
        assert_eq!(code, 1, "{stderr}");
        assert!(stderr.contains(word), "{stderr}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
