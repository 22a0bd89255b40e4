//! The page of `walpha view`: self-contained, whole, and safe whatever its input is called. What it
//! looks like in a browser, `scripts/check_view.py` checks.

use std::fs;

use serde_json::Value;

use crate::common::{json, ok, run};

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
    let [detail] = &made["details"].as_array().unwrap()[..] else { panic!("{made}") };
    assert_eq!((&detail["levels"], &made["simplified"]), (&Value::from(5), &Value::Null));
    assert!(!html.contains("id=\"detail\""), "there is one level of detail");
    assert!(html.contains("width=device-width"));
    // Plain scripts, no address to load anything from.
    for tag in ["<script src", "<link", "<img", "@import", "cdn.plot.ly/plotly"] {
        assert!(!html.contains(tag), "{tag}");
    }
    let data: Value = serde_json::from_str(element(&html, "data")).unwrap();
    let plot: Value = serde_json::from_str(element(&html, "plot")).unwrap();
    let names =
        plot["data"].as_array().unwrap().iter().map(|trace| trace["name"].as_str().unwrap());
    let classes = ["interior points", "regular points", "singular points"];
    let facets = ["regular facets", "singular facets", "singular edges"];
    let expected = [&facets[..], &classes, &["isosurface at 50"]].concat();
    assert_eq!(names.collect::<Vec<_>>(), expected, "the script counts on this order");
    let [page] = &data["details"].as_array().unwrap()[..] else { panic!("one level of detail") };
    assert_eq!(page["levels"].as_array().unwrap().len(), 5);
    let arrays = &page["arrays"];
    let points = detail["points"].as_u64().unwrap() as usize;
    assert_eq!(bytes(&arrays["x"]).len(), 4 * points);
    assert_eq!(bytes(&arrays["weights"]).len(), 4 * points);
    let differences = bytes(&arrays["differences"]);
    assert_eq!(differences.len(), 4 * points);
    let (numbers, _) = differences.as_chunks::<4>();
    assert!(numbers.iter().any(|&number| f32::from_le_bytes(number) > 1.0));
    assert!(html.contains("<option value=\"difference\">"));
    let facets = bytes(&arrays["facetSpans"]);
    assert_eq!(bytes(&arrays["facets"]).len(), 4 * facets.len());
    for (k, alpha) in ["1", "2", "5", "10", "inf"].iter().enumerate() {
        // The same as the shapes that the ladder measures, which other tests hold against `shape`.
        let rows = page["levels"][k]["rows"].as_array().unwrap();
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
    assert!(!html.contains("<option value=\"difference\">"), "points have no original");
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
        assert_eq!(code, 2, "{stderr}");
        assert!(stderr.contains(word), "{stderr}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// Each stop of the slider shows something, and something else than the one before; the page opens where
/// all points are in one solid component.
#[test]
fn stops_show_something_else_each() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    // Two balls of points, of different density, far from each other.
    let mut text = String::new();
    for i in 0..400 {
        let k = f64::from(i);
        let (z, turn) = (1.0 - (2.0 * k + 1.0) / 400.0, 2.399_963_2 * k);
        let r = (1.0 - z * z).sqrt();
        let (size, place) = if i % 4 == 0 { (0.2, 3.0) } else { (1.0, 0.0) };
        text +=
            &format!("{} {} {}\n", place + size * r * turn.cos(), size * r * turn.sin(), size * z);
    }
    fs::write(f.join("balls.xyz"), text).unwrap();
    for (input, above) in [("balls.xyz", false), ("sample:phantom@20", false), ("balls.xyz", true)]
    {
        let mut alpha = json(f, &["shape", input])["alpha"]["squared"].as_f64().unwrap();
        let mut args = vec!["view", input, "-o", "page.html", "-q"];
        let text;
        if above {
            // One sees what one sees at the α suggested, which must go then.
            alpha = alpha.next_up();
            text = format!("--alpha={alpha}");
            args.push(&text);
        }
        ok(f, &args);
        let html = fs::read_to_string(f.join("page.html")).unwrap();
        let data: Value = serde_json::from_str(element(&html, "data")).unwrap();
        let page = &data["details"][0];
        let levels = page["levels"].as_array().unwrap();
        assert!((12..=40).contains(&levels.len()), "{input}: {}", levels.len());
        let facets = bytes(&page["arrays"]["facetSpans"]);
        let edges = bytes(&page["arrays"]["edgeSpans"]);
        for k in 0..levels.len() as u8 {
            let seen = count(&facets, k, 2) + count(&facets, k, 3) + count(&edges, k, 3);
            assert!(seen > 0, "{input}: nothing at level {k}");
            let state = |span: &[u8], k: u8| span.iter().filter(|&&level| level <= k).count();
            let other = |spans: &[u8], states: usize| {
                let short = spans.chunks(3).map(|span| &span[..states]);
                short.filter(|span| k > 0 && state(span, k) != state(span, k - 1)).count()
            };
            // A facet turns from singular to regular to interior; of an edge one sees the first.
            assert!(
                k == 0 || other(&facets, 3) + other(&edges, 2) > 0,
                "{input}: level {k} is that before"
            );
        }
        // Where it opens.
        let at = page["first"].as_u64().unwrap() as usize;
        let name = levels[at]["name"].as_str().unwrap().trim_start_matches("α = ");
        assert!(name.chars().filter(char::is_ascii_digit).count() <= 7, "{name}");
        let told: f64 = name.parse().unwrap();
        assert!((told - alpha).abs() <= 5e-4 * alpha, "{input} opens at {told}, not {alpha}");
        assert!(at > 0 && at + 1 < levels.len(), "{input} opens at {at}");
    }
    ok(f, &["view", "balls.xyz", "-o", "page.html", "-q", "--alpha", "0.5", "--alphas", "0.1,1,2"]);
    let html = fs::read_to_string(f.join("page.html")).unwrap();
    assert!(html.contains("\"name\":\"α = 0.5\"") && html.contains("\"first\":1"));
}

/// A level of detail is the page of so many points, but for what is the same at all levels.
#[test]
fn levels_of_detail_are_pages_of_fewer_points() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let args = |count: &'static str| {
        ["view", "sample:phantom@20", "--weights", "min-max", "--count", count, "-o", "page.html"]
    };
    let page = |args: &[&str]| -> (Value, Value, String) {
        let made = json(f, &[args, &["-q"]].concat());
        let html = fs::read_to_string(f.join("page.html")).unwrap();
        let data = serde_json::from_str(element(&html, "data")).unwrap();
        (made, data, html)
    };
    let (made, all, html) = page(&[&args("600")[..], &["--counts", "300,100,300"]].concat());
    let points = |made: &Value| -> Vec<u64> {
        let details = made["details"].as_array().unwrap();
        details.iter().map(|detail| detail["points"].as_u64().unwrap()).collect()
    };
    assert_eq!(points(&made), [100, 300, 600]);
    assert!(html.contains("<option value=\"2\" selected>600 points</option>"));
    let rmse = |k: usize| made["details"][k]["rmse_filled"].as_f64().unwrap();
    assert!(rmse(0) > rmse(1) && rmse(1) > rmse(2) && rmse(2) > 0.0, "{made}");
    for (k, count) in ["100", "300", "600"].into_iter().enumerate() {
        let (alone, one, _) = page(&args(count));
        assert_eq!(alone["details"][0], made["details"][k]);
        assert!(one["details"][0] == all["details"][k], "{count} points");
        assert!(one["isosurface"] == all["isosurface"] && !one["isosurface"].is_null());
    }
    fs::write(f.join("points.xyz"), "0 0 0\n1 0 0\n0 1 0\n0 0 1\n").unwrap();
    let (code, _, stderr) = run(f, &["view", "points.xyz", "--counts", "3", "-o", "page.html"]);
    assert!(code == 2 && stderr.contains("--counts"), "{stderr}");
}

#[test]
fn the_page_explains_itself() {
    let folder = tempfile::tempdir().unwrap();
    ok(folder.path(), &["view", "sample:phantom@12", "-o", "page.html", "-q"]);
    let html = fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(element(&html, "data").contains("F: value of the original volume, in gray levels"));
    for id in ["play", "reset", "save", "scene", "level", "colour"] {
        assert!(html.contains(&format!("id=\"{id}\"")), "{id}");
    }
}
