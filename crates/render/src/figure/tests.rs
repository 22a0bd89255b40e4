use super::*;
use crate::pixels::ColourMap;

fn square() -> Drawing {
    let mut drawing = Drawing::plane([[0.0, 0.0], [4.0, 4.0]]);
    let corners = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]];
    drawing.polygon(&corners, Pen::area(Rgb([255, 0, 0]), 1.0));
    drawing
}

fn panel(title: &str, content: Content) -> Panel {
    Panel { title: title.into(), content, captions: vec!["b₀ = 1 & b₁ < 2".into()] }
}

fn figure(panels: Vec<Panel>) -> Figure {
    Figure {
        title: "A title".into(),
        columns: 2,
        panel: Size::new(400, 300).unwrap(),
        panels,
        colour_bar: Some(ColourBar {
            map: ColourMap::new(0.0, 255.0),
            label: "F (gray levels)".into(),
        }),
        legend: vec![("singular facets".into(), Rgb([0, 0, 255]))],
        notes: vec!["A note.".into()],
    }
}

#[test]
fn png_and_svg_are_the_same_each_time_and_show_the_panels() {
    let red = Picture::new(Size::new(4, 3).unwrap(), vec![[255, 0, 0, 255]; 12]);
    let panels = vec![
        panel("first", Content::Picture(red)),
        panel("second", Content::Drawing(square())),
        panel("third", Content::Drawing(Drawing::chart([[0.0, 0.0], [1.0, 2.0]], "N", "RMSE"))),
    ];
    let figure = figure(panels);
    let svg = figure.to_svg().unwrap();
    for part in ["(a) first", "(b) second", "(c) third", "b₁ &lt; 2", "data:image/png;base64,"] {
        assert!(svg.contains(part), "{part} is missing");
    }
    assert_eq!(svg, figure.to_svg().unwrap());
    let picture = figure.to_picture().unwrap();
    assert_eq!(picture, figure.to_picture().unwrap());
    assert!(picture.size().width() >= Figure::MIN_WIDTH);
    let share = |colour: [u8; 4]| {
        let hits = picture.pixels().iter().filter(|&&p| p == colour).count() as f64;
        let scale = f64::from(picture.size().width()) / 842.0;
        hits / (scale * scale)
    };
    // The red picture fills a panel, the square (half as high as the panel) a part of another.
    let expected = 400.0 * 300.0 + 150.0 * 150.0;
    let got = share([255, 0, 0, 255]);
    assert!((got / expected - 1.0).abs() < 0.02, "{got} red pixels, not {expected}");
    assert!(share([0, 0, 255, 255]) > 30.0);
    assert_eq!(picture.pixel(0, 0), [255; 4]);
}

#[test]
fn a_single_panel_has_no_letter_and_nothing_at_all_is_a_page() {
    let svg = figure(vec![panel("only", Content::Drawing(square()))]).to_svg().unwrap();
    assert!(svg.contains(">only<") && !svg.contains("(a)"));
    figure(Vec::new()).to_png().unwrap();
}

#[test]
fn panels_beyond_any_picture_are_refused() {
    let mut wide = figure(vec![panel("w", Content::Drawing(square())); 3]);
    wide.columns = 3;
    wide.panel = Size::new(Size::MAX_SIDE, 8).unwrap();
    assert!(matches!(wide.to_png(), Err(RenderError::Size { .. })));
}

#[test]
fn letters_go_on_after_z() {
    assert_eq!([0, 25, 26, 27, 51, 52].map(letter), ["a", "z", "aa", "ab", "az", "ba"]);
}

#[test]
fn captions_wrap_at_words() {
    let lines = wrap("one two three four", 60.0, 10.0);
    assert_eq!(lines, ["one two", "three four"]);
    assert_eq!(wrap("incomprehensibilities", 10.0, 10.0).len(), 1);
    assert!(wrap("", 10.0, 10.0).is_empty());
}
