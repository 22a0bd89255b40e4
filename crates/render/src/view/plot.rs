use plotly::color::Rgb;
use plotly::common::{
    Anchor, ColorBar, ColorScale, ColorScalePalette, Font, HoverInfo, Line, Mode, Orientation,
    Side, Title, Visible,
};
use plotly::configuration::DisplayModeBar;
use plotly::layout::{
    AspectMode, Axis, Camera, Eye, ItemSizing, LayoutScene, Legend, Margin, TraceOrder,
};
use plotly::traces::mesh3d::{IntensityMode, LightPosition, Lighting};
use plotly::{Configuration, Layout, Mesh3D, Plot, Scatter3D};

use super::subject::Subject;
use crate::colour::PALETTE;

/// The traces, in the order in which the page's script fills them, and the layout. The traces have no data: the
/// arrays of a level are put together in the browser.
pub(super) fn plot(subject: &Subject<'_>) -> Plot {
    let mut plot = Plot::new();
    // With plotly's bound, facets that are a thousandth as long as the shape or less have no normal, and are dark.
    let lighting = Lighting::new()
        .ambient(0.8)
        .diffuse(0.9)
        .specular(0.1)
        .roughness(0.8)
        .face_normals_epsilon(0.0);
    let mesh = |name: &str, colour: Rgb| {
        Mesh3D::<f64, f64, f64>::new(vec![], vec![], vec![], None::<Vec<usize>>, None, None)
            .name(name)
            .show_legend(true)
            .color(colour)
            .flat_shading(true)
            .lighting(lighting.clone())
            .light_position(LightPosition::new().x(vec![-1e4]).y(vec![-2e4]).z(vec![2e4]))
            .hover_info(HoverInfo::Text)
    };
    let by_value = |mesh: Box<Mesh3D<f64, f64, f64>>| {
        mesh.intensity_mode(IntensityMode::Vertex)
            .color_scale(ColorScale::Palette(ColorScalePalette::Viridis))
    };
    plot.add_trace(by_value(mesh("regular facets", rgb(1))).color_bar(colour_bar()));
    plot.add_trace(by_value(mesh("singular facets", rgb(0))));
    plot.add_trace(
        Scatter3D::<f64, f64, f64>::new(vec![], vec![], vec![])
            .name("singular edges")
            .mode(Mode::Lines)
            .line(Line::new().color(rgb(3)).width(2.0))
            .hover_info(HoverInfo::Skip),
    );
    // A legend has one colour for a trace, so that each class has its own.
    for class in ["interior", "regular", "singular"] {
        plot.add_trace(
            Scatter3D::<f64, f64, f64>::new(vec![], vec![], vec![])
                .name(format!("{class} points"))
                .legend_group("points")
                .show_legend(true)
                .mode(Mode::Markers)
                .visible(Visible::LegendOnly)
                .hover_info(HoverInfo::Text),
        );
    }
    if let Some(original) = &subject.original {
        plot.add_trace(
            mesh(&format!("isosurface at {}", original.isovalue), Rgb::new(190, 190, 190))
                .opacity(0.5)
                .visible(Visible::LegendOnly)
                .hover_info(HoverInfo::Skip),
        );
    }
    plot.set_layout(layout(subject.unit));
    plot.set_configuration(
        Configuration::new().responsive(true).display_mode_bar(DisplayModeBar::False),
    );
    plot
}

/// Its title is set by the script.
fn colour_bar() -> ColorBar {
    ColorBar::new()
        .title(Title::new().side(Side::Top).font(Font::new().size(12)))
        .orientation(Orientation::Horizontal)
        .thickness(12)
        .y(0.0)
        .y_anchor(Anchor::Top)
        .tick_font(Font::new().size(11))
}

fn rgb(index: usize) -> Rgb {
    let [r, g, b] = PALETTE[index].0;
    Rgb::new(r, g, b)
}

fn layout(unit: &str) -> Layout {
    // A sentence is too long for the label of an axis.
    let label =
        |name: &str| if unit.contains(' ') { name.to_owned() } else { format!("{name} ({unit})") };
    let axis = |name: &str| Axis::new().title(Title::with_text(label(name))).n_ticks(6);
    // From where to look; the script finds how far away.
    let camera = Camera::new().eye(Eye::from((1.0, -1.62, 0.76)));
    let scene = LayoutScene::new()
        .aspect_mode(AspectMode::Manual)
        .camera(camera)
        .x_axis(axis("x"))
        .y_axis(axis("y"))
        .z_axis(axis("z"));
    Layout::new()
        .scene(scene)
        .auto_size(true)
        .margin(Margin::new().left(0).right(0).top(8).bottom(10))
        .show_legend(true)
        .legend(
            Legend::new()
                .orientation(Orientation::Horizontal)
                // Points are switched together, and listed like the others.
                .trace_order(TraceOrder::Normal)
                .item_sizing(ItemSizing::Constant)
                .x(0.0)
                .y(1.0)
                .y_anchor(Anchor::Bottom),
        )
}
