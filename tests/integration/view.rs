//! The page of `walpha view`: self-contained, complete, and safe for any name of its input. Its look in a browser is checked by
//! `scripts/check_view.py`.

use std::collections::BTreeMap;
use std::fs;
use std::io::Read;

use flate2::read::GzDecoder;
use serde_json::Value;

use crate::common::{json, ok, run};

/// The text of the element with this id.
fn element<'a>(html: &'a str, id: &str) -> &'a str {
    let start = html.find(&format!("id=\"{id}\"")).expect("an element of that name");
    let start = start + html[start..].find('>').expect("its end") + 1;
    &html[start..start + html[start..].find("</script>").expect("a script")]
}

fn base64(text: &str) -> Vec<u8> {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let (mut bits, mut count, mut bytes) = (0u32, 0, Vec::new());
    for letter in text.trim_end_matches('=').bytes() {
        let value = LETTERS.iter().position(|&l| l == letter).expect("base64") as u32;
        (bits, count) = (bits << 6 | value, count + 6);
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    bytes
}

/// The content of an element: an object, and the bytes of its arrays.
#[derive(Debug, PartialEq)]
struct Unpacked {
    content: Value,
    arrays: BTreeMap<String, Vec<u8>>,
}

impl Unpacked {
    fn of(html: &str, id: &str) -> Self {
        let mut bytes = Vec::new();
        GzDecoder::new(&base64(element(html, id))[..]).read_to_end(&mut bytes).expect("gzip");
        let (length, rest) = bytes.split_first_chunk::<4>().expect("a length");
        let length = u32::from_le_bytes(*length) as usize;
        let mut content: Value = serde_json::from_slice(&rest[..length]).expect("an object");
        let start = (4 + length).next_multiple_of(8);
        let places = content.as_object_mut().unwrap().remove("arrays").expect("places");
        let array = |(name, place): (&String, &Value)| {
            let width = match place["kind"].as_str().unwrap() {
                "Uint8Array" => 1,
                "Uint32Array" | "Float32Array" => 4,
                "Float64Array" => 8,
                kind => panic!("{kind}"),
            };
            let [at, length] = ["at", "length"].map(|key| place[key].as_u64().unwrap() as usize);
            assert_eq!(at % 8, 0, "{name} is aligned");
            (name.clone(), bytes[start + at..][..width * length].to_vec())
        };
        let arrays = places.as_object().unwrap().iter().map(array).collect();
        Self { content, arrays }
    }

    fn f32(&self, name: &str) -> Vec<f32> {
        let (numbers, rest) = self.arrays[name].as_chunks::<4>();
        assert!(rest.is_empty());
        numbers.iter().map(|&number| f32::from_le_bytes(number)).collect()
    }

    fn u32(&self, name: &str) -> Vec<u32> {
        let (numbers, rest) = self.arrays[name].as_chunks::<4>();
        assert!(rest.is_empty());
        numbers.iter().map(|&number| u32::from_le_bytes(number)).collect()
    }

    fn alphas(&self) -> Vec<f64> {
        let (numbers, rest) = self.arrays["alphas"].as_chunks::<8>();
        assert!(rest.is_empty());
        numbers.iter().map(|&number| f64::from_le_bytes(number)).collect()
    }

    fn levels(&self) -> &[Value] {
        self.content["levels"].as_array().unwrap()
    }
}

/// The number of rows of three levels that have this class at a level: 2 regular, 3 singular.
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
    assert!(html.contains("width=device-width"));
    // Plain scripts, no address to load anything from.
    for tag in ["<script src", "<link", "<img", "@import", "wasm-unsafe-eval"] {
        assert!(!html.contains(tag), "{tag}");
    }
    let whole = Unpacked::of(&html, "page");
    let points = detail["points"].as_u64().unwrap() as usize;
    assert_eq!(whole.content["points"], Value::from(vec![points]), "there is one level of detail");
    assert_eq!(whole.content["isovalue"], 50.0);
    assert!(whole.arrays["triangles"].len() > 100 * 12 && !html.contains("id=\"detail-1\""));
    let page = Unpacked::of(&html, "detail-0");
    assert_eq!(page.levels().len(), 5);
    assert_eq!(page.alphas(), [1.0, 2.0, 5.0, 10.0, f64::INFINITY]);
    assert_eq!(page.f32("positions").len(), 3 * points);
    assert_eq!(page.f32("weights").len(), points);
    let differences = page.f32("differences");
    assert_eq!(differences.len(), points);
    assert!(differences.iter().any(|&number| number > 1.0));
    let facets = &page.arrays["facetSpans"];
    assert_eq!(page.arrays["facets"].len(), 4 * facets.len());
    for (k, level) in page.levels().iter().enumerate() {
        // The same as the shapes that the ladder measures, which other tests compare with `shape`.
        for (class, name) in [(2, "regular"), (3, "singular")] {
            assert_eq!(level["facets"][name], count(facets, k as u8, class), "{name}: {level}");
        }
        assert!(count(facets, k as u8, 2) > 0);
    }
    // Each void has the facets around it: a cone over them has its volume.
    let voids: Vec<&Value> =
        page.levels().iter().flat_map(|level| level["voids"].as_array().unwrap()).collect();
    let (counts, corners) = (page.u32("voidCounts"), page.u32("voidFacets"));
    assert_eq!((counts.len(), whole.content["space"].as_str()), (voids.len(), Some("unknown")));
    assert!(voids.len() > 1);
    let positions = page.f32("positions");
    let place = |v: &u32| [0, 1, 2].map(|k| f64::from(positions[3 * *v as usize + k]));
    let mut rest = &corners[..];
    for (void, count) in voids.iter().zip(counts) {
        let (own, after) = rest.split_at(3 * count as usize);
        let six: f64 = own
            .chunks(3)
            .map(|row| {
                let [[a, b, c], [d, e, f], [g, h, i]] = [0, 1, 2].map(|k| place(&row[k]));
                a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g)
            })
            .sum();
        let volume = void["volume"].as_f64().unwrap();
        assert!((six / 6.0 - volume).abs() < 1e-3 * volume.max(1.0), "{six} {void}");
        rest = after;
    }
    assert!(rest.is_empty());
}

/// Atoms have their elements in the page, with the colours of these.
#[test]
fn the_page_knows_elements() {
    let folder = tempfile::tempdir().unwrap();
    ok(folder.path(), &["view", "sample:peptide", "-o", "page.html", "-q"]);
    let page =
        Unpacked::of(&fs::read_to_string(folder.path().join("page.html")).unwrap(), "detail-0");
    let atoms = &page.arrays["atoms"];
    assert_eq!(atoms.len(), page.f32("weights").len());
    let elements = page.content["elements"].as_object().unwrap();
    let named: Vec<(&str, &str)> = elements
        .iter()
        .map(|(number, known)| (number.as_str(), known["name"].as_str().unwrap()))
        .collect();
    assert_eq!(named, [("6", "C"), ("7", "N"), ("8", "O")]);
    assert_eq!(elements["8"]["colour"], serde_json::json!([255, 13, 13]));
    // Between two nitrogens of a chain are two carbons, of which the second bears an oxygen.
    assert_eq!(atoms[..5], [7, 6, 6, 8, 6]);
}

/// Points of a scan have their classes in the page, with the names and colours of these.
#[test]
fn the_page_knows_classes() {
    let folder = tempfile::tempdir().unwrap();
    ok(folder.path(), &["view", "sample:tile", "-o", "page.html", "-q"]);
    let html = fs::read_to_string(folder.path().join("page.html")).unwrap();
    let page = Unpacked::of(&html, "detail-0");
    let codes = &page.arrays["codes"];
    assert_eq!(codes.len(), page.f32("weights").len());
    let told = json(folder.path(), &["info", "sample:tile"]);
    let names = page.content["classNames"].as_object().unwrap();
    assert_eq!(names["2"], serde_json::json!({ "name": "ground", "colour": [170, 85, 0] }));
    assert_eq!(names.len(), told["classes"].as_object().unwrap().len());
    for (class, count) in told["classes"].as_object().unwrap() {
        assert!(names.contains_key(class), "{class}");
        let class: u8 = class.parse().unwrap();
        let counted: u64 = codes.iter().map(|&code| u64::from(code == class)).sum();
        assert_eq!(count.as_u64(), Some(counted));
    }
    assert!(!page.arrays.contains_key("atoms"));
}

/// Simplices of a periodic box are laid out in space, with copies of points beyond its sides, and the box is drawn.
#[test]
fn a_periodic_box_is_laid_out_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let lattice = (0..64).map(|i| format!("{} {} {}\n", i % 4, i / 4 % 4, i / 16));
    fs::write(f.join("cubic.xyz"), lattice.collect::<String>()).unwrap();
    fs::write(f.join("one.xyz"), "0 0 0\n").unwrap();
    for (input, sides, points) in [("cubic.xyz", "4,4,4", 64), ("one.xyz", "1,1,1", 1)] {
        let args =
            ["view", input, "--periodic", sides, "--alphas", "0.3,0.6,inf", "-o", "page.html"];
        let made = json(f, &[&args[..], &["-q"]].concat());
        assert_eq!(made["details"][0]["points"], points);
        let html = fs::read_to_string(f.join("page.html")).unwrap();
        let (page, detail) = (Unpacked::of(&html, "page"), Unpacked::of(&html, "detail-0"));
        let centre = |k: usize| page.content["centre"][k].as_f64().unwrap();
        let cell = page.content["cell"].as_array().unwrap();
        let side: f64 = sides[..1].parse().unwrap();
        assert_eq!(cell[0].as_array().unwrap().len(), 3);
        assert_eq!([0, 1, 2].map(|k| cell[0][k].as_f64().unwrap() + centre(k)), [0.0; 3]);
        assert_eq!([1, 2, 3].map(|k| cell[k][k - 1].as_f64().unwrap()), [side; 3]);
        let copies = detail.u32("copies");
        let positions = detail.f32("positions");
        assert_eq!(positions.len() / 3, points + copies.len());
        // A cubic lattice has three squares for each point at its second level, halved by diagonals, which is all that is seen: at the next, all is full.
        let facets = detail.u32("facets");
        assert!(facets.len() / 3 == 6 * points && copies.len() >= 6, "{}", copies.len());
        for corners in facets.chunks(3) {
            for k in 0..3 {
                let along = corners.iter().map(|v| positions[3 * *v as usize + k]);
                let [low, high] = [f32::min, f32::max].map(|of| along.clone().reduce(of).unwrap());
                assert!(high - low <= 1.0 && f64::from(low) + centre(k) < side, "{corners:?}");
            }
        }
        // A copy is as far from its point as multiples of the sides.
        for (copy, of) in (points..).zip(copies) {
            let way = |k: usize| positions[3 * copy + k] - positions[3 * of as usize + k];
            assert!((0..3).all(|k| f64::from(way(k)) % side == 0.0));
        }
        assert!(page.content["facts"].to_string().contains("periodic box"));
    }
    let refused = |more: &[&str]| {
        let args = ["view", "cubic.xyz", "--periodic", "4,4,4", "-o", "page.html"];
        let (code, _, told) = run(f, &[&args[..], more].concat());
        assert_eq!(code, 2, "{told}");
        told
    };
    assert!(refused(&["--keep", "largest"]).contains("--keep"));
    assert!(refused(&["--counts", "20"]).contains("--counts"));
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
    let told = ok(folder.path(), &["view", &name, "-o", "page.html"]);
    assert!(told.contains("wrote     page.html, ") && told.contains(" MB"), "{told}");
    let html = fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(!html.contains("<script>alert"));
    assert_eq!(html.matches("&lt;script&gt;alert(1)").count(), 2, "a title and a heading");
    let said = Unpacked::of(&html, "page").content["facts"][0].to_string();
    assert!(said.contains("<script>alert(1)"), "the script shows it as text: {said}");
    let page = Unpacked::of(&html, "detail-0");
    assert!(!page.arrays.contains_key("differences"), "points have no original");
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
            // The page shows the same as at the suggested α, which must be removed then.
            alpha = alpha.next_up();
            text = format!("--alpha={alpha}");
            args.push(&text);
        }
        ok(f, &args);
        let html = fs::read_to_string(f.join("page.html")).unwrap();
        let page = Unpacked::of(&html, "detail-0");
        let levels = page.levels();
        assert!((12..=40).contains(&levels.len()), "{input}: {}", levels.len());
        let (facets, edges) = (&page.arrays["facetSpans"], &page.arrays["edgeSpans"]);
        for k in 0..levels.len() as u8 {
            let seen = count(facets, k, 2) + count(facets, k, 3) + count(edges, k, 3);
            assert!(seen > 0, "{input}: nothing at level {k}");
            let state = |span: &[u8], k: u8| span.iter().filter(|&&level| level <= k).count();
            let other = |spans: &[u8], states: usize| {
                let short = spans.chunks(3).map(|span| &span[..states]);
                short.filter(|span| k > 0 && state(span, k) != state(span, k - 1)).count()
            };
            // A facet turns from singular to regular to interior; of an edge one sees the first.
            assert!(
                k == 0 || other(facets, 3) + other(edges, 2) > 0,
                "{input}: level {k} is that before"
            );
        }
        // The level at which it opens.
        let at = page.content["first"].as_u64().unwrap() as usize;
        let told = page.alphas()[at];
        assert!(
            told <= alpha && alpha - told <= 5e-4 * alpha,
            "{input} opens at {told}, not {alpha}"
        );
        assert!(at > 0 && at + 1 < levels.len(), "{input} opens at {at}");
    }
    ok(f, &["view", "balls.xyz", "-o", "page.html", "-q", "--alpha", "0.5", "--alphas", "0.1,1,2"]);
    let html = fs::read_to_string(f.join("page.html")).unwrap();
    let page = Unpacked::of(&html, "detail-0");
    assert_eq!(
        (page.alphas(), &page.content["first"]),
        (vec![0.1, 0.5, 1.0, 2.0], &Value::from(1))
    );
}

/// A level of detail has some of the points of the shape, spread over all of them, so that it does not fall apart; that of the shape
/// is its page without others, except for the parts that are the same at all levels.
#[test]
fn levels_of_detail_are_pages_of_fewer_points() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let args = |count: &'static str| {
        ["view", "sample:phantom@20", "--weights", "min-max", "--count", count, "-o", "page.html"]
    };
    let page = |args: &[&str]| -> (Value, String) {
        let made = json(f, &[args, &["-q"]].concat());
        (made, fs::read_to_string(f.join("page.html")).unwrap())
    };
    let (made, all) = page(&[&args("600")[..], &["--counts", "300,100,300"]].concat());
    let points = |made: &Value| -> Vec<u64> {
        let details = made["details"].as_array().unwrap();
        details.iter().map(|detail| detail["points"].as_u64().unwrap()).collect()
    };
    assert_eq!(points(&made), [100, 300, 600]);
    assert_eq!(Unpacked::of(&all, "page").content["points"], Value::from(vec![100, 300, 600]));
    let rmse = |k: usize| made["details"][k]["rmse_filled_in_values"].as_f64().unwrap();
    assert!(rmse(0) > rmse(1) && rmse(1) > rmse(2) && rmse(2) > 0.0, "{made}");
    // F of a tissue says nothing of the rest of the volume.
    let (tissue, html) = page(&[&args("100")[..], &["--gray-min", "100"]].concat());
    assert_eq!(tissue["details"][0]["rmse_filled_in_values"], Value::Null);
    assert!(!Unpacked::of(&html, "detail-0").content["arrays"].to_string().contains("differences"));
    let (alone, one) = page(&args("600"));
    assert_eq!(alone["details"][0], made["details"][2]);
    // Positions are as seen from a centre, which is that of all levels of detail.
    let places = |html: &str, detail: usize| -> Vec<[String; 3]> {
        let centre = &Unpacked::of(html, "page").content["centre"];
        let positions = Unpacked::of(html, &format!("detail-{detail}")).f32("positions");
        let at = |k: usize, x: f32| format!("{:.3}", f64::from(x) + centre[k].as_f64().unwrap());
        positions.chunks(3).map(|place| [0, 1, 2].map(|k| at(k, place[k]))).collect()
    };
    let details = [(&one, 0), (&all, 2)].map(|(html, k)| {
        let mut detail = Unpacked::of(html, &format!("detail-{k}"));
        detail.arrays.remove("positions");
        detail
    });
    assert!(details[0] == details[1] && places(&one, 0) == places(&all, 2));
    let [coarse, middle, fine] = [0, 1, 2].map(|k| places(&all, k));
    let within = |some: &[[String; 3]], of: &[[String; 3]]| some.iter().all(|at| of.contains(at));
    assert_eq!(coarse.len(), 100);
    assert!(within(&coarse, &middle) && within(&middle, &fine));
    // No point is as far from the coarsest level as from as many points of largest difference.
    let farthest = |from: &[[String; 3]]| {
        let number = |text: &String| text.parse::<f64>().unwrap();
        let squared = |a: &[String; 3], b: &[String; 3]| -> f64 {
            (0..3).map(|k| (number(&a[k]) - number(&b[k])).powi(2)).sum()
        };
        let nearest = |at| from.iter().map(|other| squared(at, other)).fold(f64::MAX, f64::min);
        fine.iter().map(nearest).fold(0.0, f64::max)
    };
    let (spread, largest) = (farthest(&coarse), farthest(&places(&page(&args("100")).1, 0)));
    assert!(2.0 * spread < largest, "{spread}, {largest}");
    let whole = Unpacked::of(&all, "page");
    assert_eq!(Unpacked::of(&one, "page").arrays["triangles"], whole.arrays["triangles"]);
    assert!(!whole.arrays["triangles"].is_empty());
    fs::write(f.join("points.xyz"), "0 0 0\n1 0 0\n0 1 0\n0 0 1\n").unwrap();
    let (code, _, stderr) = run(f, &["view", "points.xyz", "--counts", "3", "-o", "page.html"]);
    assert!(code == 2 && stderr.contains("--counts"), "{stderr}");
}

#[test]
fn the_page_explains_itself() {
    let folder = tempfile::tempdir().unwrap();
    ok(folder.path(), &["view", "sample:phantom@12", "-o", "page.html", "-q"]);
    let html = fs::read_to_string(folder.path().join("page.html")).unwrap();
    let whole = Unpacked::of(&html, "page").content;
    assert_eq!(whole["titles"]["value"], "F (value of the original volume, in gray levels)");
    assert!(whole["titles"]["difference"].as_str().unwrap().contains("gray levels"));
    for id in ["play", "home", "save-png", "scene", "alpha", "colour", "detail"] {
        assert!(html.contains(&format!("id=\"{id}\"")), "{id}");
    }
}

/// Pages draw in single precision, as seen from the centre, which they state where it matters.
#[test]
fn far_from_the_origin_a_page_states_its_offset() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for (far, is_stated) in [(0.0, false), (5_412_345.6, true)] {
        let grid = (0..64).map(|i| [i % 4, i / 4 % 4, i / 16].map(|k| 0.05 * f64::from(k)));
        let rows = grid.map(|[x, y, z]| format!("{x:.2},{:.2},{z:.2}\n", far + y));
        fs::write(f.join("grid.csv"), format!("x,y,z\n{}", rows.collect::<String>())).unwrap();
        ok(f, &["view", "grid.csv", "-o", "grid.html"]);
        let page = Unpacked::of(&fs::read_to_string(f.join("grid.html")).unwrap(), "page");
        let facts = page.content["facts"].to_string();
        assert_eq!(facts.contains("in single precision, after"), is_stated, "{facts}");
        assert!(!facts.contains("is not exact"), "{facts}");
    }
}

/// An isovalue that no sample reaches has no surface, which is said in the terms in which it was given.
#[test]
fn an_isovalue_is_named_as_it_was_given() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    ok(f, &["haar", "sample:phantom@16", "-o", "p.nrrd"]);
    for (given, words) in [
        ("40", None),
        ("40v", None),
        ("9999", Some("no isosurface at gray 9999, as gray levels go from ")),
        ("9999v", Some("no isosurface at 9999, as values go from ")),
    ] {
        let (code, _, said) = run(f, &["view", "p.nrrd", "--isovalue", given, "-o", "p.html"]);
        assert_eq!(code, 0, "{said}");
        match words {
            Some(words) => assert!(said.contains(words), "{said}"),
            None => assert!(!said.contains("no isosurface"), "{said}"),
        }
    }
}

/// The page opens at what is asked for, and says so.
#[test]
fn the_page_opens_where_it_says() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let text: String = (0..64).map(|n| format!("{} {} {}\n", n % 4, n / 4 % 4, n / 16)).collect();
    fs::write(f.join("p.xyz"), text).unwrap();
    for (asked, alpha, words) in [
        ("--radius 1", 1.0, "ball radius 1 unit (α = 1 unit²)"),
        ("--radius 0.3", 0.09, "ball radius 0.3 unit (α = 0.09 unit²)"),
        ("--alpha 2", 2.0, "ball radius 1.414 unit (α = 2 unit²)"),
        ("--alpha inf", f64::INFINITY, "α = inf, the convex hull"),
    ] {
        let args = format!("view p.xyz {asked} -q -o p.html");
        ok(f, &args.split(' ').collect::<Vec<_>>());
        let html = fs::read_to_string(f.join("p.html")).unwrap();
        let facts = Unpacked::of(&html, "page").content["facts"].clone();
        let fact = serde_json::json!(["opens at", words]);
        assert!(facts.as_array().unwrap().contains(&fact), "{asked}: {facts}");
        let page = Unpacked::of(&html, "detail-0");
        let first = page.content["first"].as_u64().unwrap() as usize;
        assert_eq!(page.alphas()[first], alpha, "{asked}");
    }
}

/// What is kept of a scan has its classes, and names points as the input does.
#[test]
fn kept_points_keep_their_classes_and_names() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    ok(f, &["view", "sample:tile", "-o", "all.html", "-q"]);
    ok(f, &["view", "sample:tile", "--keep", "largest", "-o", "kept.html", "-q"]);
    let [all, kept] = ["all.html", "kept.html"]
        .map(|name| Unpacked::of(&fs::read_to_string(f.join(name)).unwrap(), "detail-0"));
    assert!(!all.arrays.contains_key("indices"));
    let indices = kept.u32("indices");
    let codes = &kept.arrays["codes"];
    assert!(indices.len() == codes.len() && codes.len() < all.arrays["codes"].len());
    assert!(indices.is_sorted() && indices.iter().zip(0..).any(|(&index, v)| index != v));
    for (&index, code) in indices.iter().zip(codes) {
        assert_eq!(*code, all.arrays["codes"][index as usize]);
    }
    assert_eq!(kept.content["classNames"], all.content["classNames"]);
}

/// Values that single precision does not tell apart are doubles in the page.
#[test]
fn values_far_from_0_stay_apart() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for (far, kind) in [(0.0, 4), (1e9, 8), (1e300, 8)] {
        let row = |n: u32| {
            let value = if far == 1e300 && n > 0 { 0.1 } else { far + 0.5 * f64::from(n) };
            format!("{} {} {} {value:e}\n", n % 4, n / 4 % 4, n / 16)
        };
        fs::write(f.join("p.xyz"), (0..64).map(row).collect::<String>()).unwrap();
        ok(f, &["view", "p.xyz", "--columns", "x,y,z,value", "-q", "-o", "p.html"]);
        let html = fs::read_to_string(f.join("p.html")).unwrap();
        let page = Unpacked::of(&html, "detail-0");
        assert_eq!(page.arrays["values"].len(), 64 * kind, "{far}");
    }
}
