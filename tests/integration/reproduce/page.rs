//! The numbers of the page against those of the report.

use std::collections::BTreeMap;

use serde_json::Value;

/// Numbers as they stand in a text, signs left out.
fn numbers(text: &str) -> Vec<String> {
    let parts = text.split(|c: char| !c.is_ascii_digit() && c != '.');
    let trimmed = parts.map(|part| part.trim_matches('.').to_owned());
    trimmed.filter(|part| part.parse::<f64>().is_ok()).collect()
}

/// The visible text of a part of a page: no tags, no pictures.
fn visible(html: &str) -> String {
    let mut text = String::new();
    for part in html.split('<') {
        text += part.split_once('>').map_or("", |(_, words)| words);
        text.push(' ');
    }
    text
}

/// A number that the page must show: as in a text, or rounded to the number of digits that are shown.
#[derive(Clone)]
enum Shown {
    Word(String),
    Rounded(f64),
}

/// The numbers in a text of the report, which the page shows without changes.
fn words(text: &Value) -> Vec<Shown> {
    numbers(text.as_str().expect("a text")).into_iter().map(Shown::Word).collect()
}

/// A number, unless it is infinite: the page has ∞ for it, which is not a number here.
fn rounded(number: &Value) -> Vec<Shown> {
    match number.as_str() {
        Some("inf") => Vec::new(),
        _ => vec![Shown::Rounded(number.as_f64().expect("a number"))],
    }
}

fn each<'a>(list: &'a Value, shown: impl Fn(&'a Value) -> Vec<Shown>) -> Vec<Shown> {
    list.as_array().expect("a list").iter().flat_map(shown).collect()
}

/// Each number of the page is the one that belongs there, to the digits shown.
pub fn numbers_stand_in_the_report(files: &BTreeMap<String, Vec<u8>>, report: &Value) {
    let html = String::from_utf8(files["report.html"].clone()).unwrap();
    // The letters alone may stand in a picture, which is written in 64 signs without a colon.
    assert_eq!(html.matches("<main>").count(), 1);
    assert!(!html.contains("<th></th>"), "a heading says something");
    for item in report["items"].as_array().unwrap() {
        let link = format!("<li><a href=\"#{}\">", item["id"].as_str().unwrap());
        assert!(html.contains(&link), "contents: {link}");
    }
    let elsewhere = ["<script", "http:", "https:"].into_iter().find(|part| html.contains(part));
    assert_eq!(elsewhere, None, "a page on its own");
    let made =
        format!("walpha {}, {}.", env!("CARGO_PKG_VERSION"), report["date"].as_str().unwrap());
    assert!(html.contains(&made), "{made}");
    assert!(html.contains("In plain words.") && html.contains("stays open"), "the conclusion");
    assert!(html.contains("<a href=\"figure-10.png\"><img"), "figures open large");
    let mut sections = html.split("<section").skip(1);
    let volume = sections.next().expect("a section on the volume");
    let origin = &report["input"]["origin"];
    compare("volume", &visible(&format!("<section{volume}")), {
        [words(&origin["source"]), words(&origin["judgement"])].concat()
    });
    for item in report["items"].as_array().unwrap() {
        let section = sections.next().expect("a section for each item");
        let id = item["id"].as_str().unwrap();
        assert!(section.starts_with(&format!(" id=\"{id}\">")), "{id} has its place");
        compare(id, &visible(&format!("<section{section}")), of_item(item));
    }
    let head = html.split("<section").next().unwrap();
    let (head, rest) = head.split_once("<style>").unwrap();
    let (_, rest) = rest.split_once("</style>").unwrap();
    compare("head", &visible(&(head.to_owned() + rest)), of_head(report));
}

fn compare(place: &str, text: &str, expected: Vec<Shown>) {
    let shown = numbers(text);
    assert_eq!(shown.len(), expected.len(), "{place}: {shown:?}");
    for (k, (shown, expected)) in shown.iter().zip(expected).enumerate() {
        let near = &text[..text.len().min(4000)];
        match expected {
            Shown::Word(word) => assert_eq!(*shown, word, "number {k} of {place}: {near}"),
            Shown::Rounded(value) => {
                let decimals = shown.split_once('.').map_or(0, |(_, digits)| digits.len());
                // The page leaves zeros at the end away, and has three decimals, or eight.
                let most = if value.abs() < 0.1 { 8 } else { 3 };
                assert!(decimals <= most, "{shown} in {place}");
                let difference = (shown.parse::<f64>().unwrap() - value.abs()).abs();
                let half = 0.500_001 * 10f64.powi(-(most as i32));
                assert!(difference <= half, "number {k} of {place} is {shown}, not {value}");
            }
        }
    }
}

/// The numbers of an item in the order of the page.
fn of_item(item: &Value) -> Vec<Shown> {
    let mut all = [words(&item["title"]), words(&item["paper"]), words(&item["ours"])].concat();
    all.extend(each(&item["findings"], |f| [words(&f["claim"]), words(&f["reason"])].concat()));
    all.extend(each(&item["tables"], |table| {
        let rows = each(&table["rows"], |row| each(row, words));
        [words(&table["caption"]), each(&table["head"], words), rows].concat()
    }));
    let shapes = &item["shapes"];
    all.extend(each(shapes, |shape| words(&shape["label"])));
    let root = |shape: &Value| match shape["alpha"].as_f64() {
        Some(alpha) => vec![Shown::Rounded(alpha), Shown::Rounded(alpha.sqrt())],
        None => Vec::new(),
    };
    all.extend(each(shapes, root));
    let mut rows = |paths: &[&str]| {
        let of_shape = |shape: &Value| -> Vec<Shown> {
            let value = |path: &&str| Value::pointer(shape, path).map_or(Vec::new(), rounded);
            paths.iter().flat_map(value).collect()
        };
        all.extend(each(shapes, of_shape));
    };
    rows(&["/weights/min", "/weights/mean", "/weights/max"]);
    for path in ["/points", "/hidden", "/points_in_shape", "/cells"] {
        rows(&[path]);
    }
    for simplices in ["facets", "edges", "vertices"] {
        let of_class = |class| format!("/{simplices}/{class}");
        let paths = ["interior", "regular", "singular"].map(of_class);
        rows(&paths.each_ref().map(String::as_str));
    }
    for path in ["/betti/0", "/betti/1", "/betti/2", "/void_volume", "/largest_voids/0/volume"] {
        rows(&[path]);
    }
    for path in ["/volume", "/regular_area", "/singular_area"] {
        rows(&[path]);
    }
    all.extend(each(&item["facts"], |f| [words(&f["label"]), rounded(&f["value"])].concat()));
    all.extend(words(&item["command"]));
    all.extend(each(&item["commands"], words));
    all.extend(each(&item["files"], words));
    all
}

/// The title twice, what was worked on, and a line for each claim.
fn of_head(report: &Value) -> Vec<Shown> {
    let input = &report["input"];
    let said = |text: &str| words(&text.into());
    let verdicts = ["reproduced", "not reproduced", "cannot be decided"];
    let mut all = [
        words(&report["paper"]),
        words(&report["paper"]),
        words(&report["source"]),
        words(&report["version"]),
        words(&report["date"]),
        said("Table 1"),
        words(&input["name"]),
        each(&input["dims"], rounded),
        each(&input["gray_range"], rounded),
        said("gray levels 0 to 255"),
        rounded(&input["points"]),
        rounded(&input["samples"]),
        rounded(&input["percent"]),
    ]
    .concat();
    for number in ["kept", "total", "epsilon", "rms"] {
        all.extend(rounded(&input["haar"][number]));
    }
    all.extend(said("α = 10 with ω = 0, √10"));
    // The table of contents.
    all.extend(each(&report["items"], |item| words(&item["title"])));
    for verdict in verdicts {
        all.extend(rounded(&report["verdicts"][verdict]));
    }
    all.extend(each(&report["items"], |item| {
        let name = item["title"].as_str().unwrap().split('.').next().unwrap();
        let claims = each(&item["findings"], |finding| words(&finding["claim"]));
        if claims.is_empty() && item["findings"].as_array().unwrap().is_empty() {
            return claims;
        }
        [said(name), claims].concat()
    }));
    all
}
