use super::*;
use crate::{Ball, Colours, Mesh, Projection, Rgb, Shading, Tube, View};

const RED: Rgb = Rgb([255, 0, 0]);
const BLUE: Rgb = Rgb([0, 0, 255]);

/// Looks down from z = 10 on the square −1..1.
fn above(projection: Projection) -> Camera {
    let (eye, up) = ([0.0, 0.0, 10.0], [0.0, 1.0, 0.0]);
    Camera { eye, target: [0.0; 3], up, height: 2.0, projection }
}

fn draw(scene: &Scene, side: u32, background: Background) -> Picture {
    let size = Size::new(side, side).unwrap();
    scene.render(&above(Projection::Orthographic), size, background).unwrap()
}

fn triangle(corners: [[f64; 3]; 3], colour: Rgb) -> Mesh {
    let colours = Colours::Uniform(colour);
    Mesh { colours, two_sided: true, ..Mesh::new(corners.to_vec(), vec![[0, 1, 2]]) }
}

fn ball(centre: [f64; 3], radius: f64, colour: Rgb) -> Scene {
    Scene { balls: vec![Ball { centre, radius, colour }], ..Scene::default() }
}

/// All primitives together, scattered in the same way as when the sum of its pixels was taken.
fn crowd() -> Scene {
    let mut state = 1_u64;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1_u64 << 31) as f64 * 2.0 - 1.0
    };
    let mut point = || [next(), next(), next()];
    let mut scene = Scene::default();
    for (opacity, shading) in [(1.0, Shading::Flat), (1.0, Shading::Smooth), (0.4, Shading::Flat)] {
        let positions: Vec<_> = (0..90).map(|_| point()).collect();
        let triangles = (0..30).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let colours = Colours::Vertex((0..90).map(|k| Rgb([k * 2, 255 - k, 128])).collect());
        let mesh = Mesh::new(positions, triangles);
        scene.meshes.push(Mesh { two_sided: true, opacity, shading, colours, ..mesh });
    }
    for k in 0..40 {
        scene.balls.push(Ball { centre: point(), radius: 0.05, colour: Rgb([k, 200, 90]) });
        scene.tubes.push(Tube { ends: [point(), point()], radius: 0.01, colour: BLUE });
    }
    scene
}

#[test]
fn the_same_bytes_on_any_number_of_threads() {
    let scene = crowd();
    let camera = above(Projection::Perspective);
    let size = Size::new(200, 150).unwrap();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| scene.render(&camera, size, Background::Transparent).unwrap())
    };
    let one = on(1);
    assert!(one.pixels().iter().any(|p| p[3] == 255) && one.pixels().iter().any(|p| p[3] == 0));
    for threads in [2, 5] {
        let picture = on(threads);
        assert!(picture == one, "{threads} threads draw another picture");
        assert_eq!(picture.to_png().unwrap(), one.to_png().unwrap());
    }
    // The picture is the same on any machine: FNV-1a over all pixels. It changes only when the look is changed.
    let hash = one.pixels().as_flattened().iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    assert_eq!(hash, 0x692d_874c_fa8c_3123, "{hash:#x}");
}

#[test]
fn half_a_pixel_is_half_covered() {
    // One pixel sees the square −1..1; the triangle is its lower left half.
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0]];
    let scene = Scene { meshes: vec![triangle(corners, RED)], ..Scene::default() };
    let [_, _, _, opacity] = draw(&scene, 1, Background::Transparent).pixel(0, 0);
    // Four of the sixteen samples lie on the diagonal, and all belong to the same side of it.
    assert!((96..=160).contains(&opacity), "{opacity}");

    // An upright edge in the middle splits the samples evenly.
    let corners = [[-9.0, -9.0, 0.0], [0.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    let scene = Scene { meshes: vec![triangle(corners, RED)], ..Scene::default() };
    assert_eq!(draw(&scene, 1, Background::Transparent).pixel(0, 0)[3], 128);
}

#[test]
fn neighbours_share_samples_without_gap_or_overlap() {
    // A fan around a point that is not a sample; at opacity ½ an overlap would be denser, a gap
    // lighter than the rest.
    let mut positions = vec![[0.013, -0.027, 0.0]];
    let rim =
        [[-3.0, -3.1], [0.4, -3.0], [3.0, -2.7], [3.2, 0.3], [2.9, 3.0], [-0.7, 3.3], [-3.0, 3.0]];
    positions.extend(rim.map(|[x, y]| [x, y, 0.0]));
    let triangles = (0..7).map(|k| [0, 1 + k, 1 + (k + 1) % 7]).collect();
    let mesh = Mesh { opacity: 0.5, ..Mesh::new(positions, triangles) };
    let scene = Scene { meshes: vec![mesh], ..Scene::default() };
    let picture = draw(&scene, 64, Background::Transparent);
    for (k, pixel) in picture.pixels().iter().enumerate() {
        assert_eq!(pixel[3], 128, "pixel {k}");
    }
}

#[test]
fn a_ball_is_round_shaded_and_where_it_should_be() {
    let scene = ball([0.0; 3], 0.5, Rgb::WHITE);
    let picture = draw(&scene, 101, Background::White);
    assert_eq!(picture.pixel(0, 0), [255; 4]);
    assert_eq!(picture.pixel(50, 22), [255; 4]);
    let brightness = |x, y| u32::from(picture.pixel(x, y)[0]);
    assert!(brightness(50, 50) > 150 && brightness(50, 50) < 255);
    assert!(
        brightness(40, 38) > brightness(62, 64) + 30,
        "the key light comes from the upper left"
    );
    // π/16 of the square −1..1.
    let clear = draw(&scene, 101, Background::Transparent);
    let covered: u64 = clear.pixels().iter().map(|p| u64::from(p[3])).sum();
    let share = covered as f64 / (255.0 * 101.0 * 101.0) / (std::f64::consts::PI / 16.0);
    assert!((share - 1.0).abs() < 0.002, "{share}");
}

#[test]
fn the_nearer_hides_the_further_in_any_order() {
    let is_red = |scene: &Scene, projection| {
        let size = Size::new(9, 9).unwrap();
        let picture = scene.render(&above(projection), size, Background::White).unwrap();
        let [r, _, b, _] = picture.pixel(4, 4);
        r > b
    };
    for projection in [Projection::Perspective, Projection::Orthographic] {
        let mut scene = ball([0.0, 0.0, 0.5], 0.3, RED);
        scene.balls.extend(ball([0.0, 0.0, -0.5], 0.6, BLUE).balls);
        assert!(is_red(&scene, projection));
        scene.balls.reverse();
        assert!(is_red(&scene, projection));
        // A triangle between them hides only the farther one, and above them it hides both.
        let at = |z| [[-5.0, -5.0, z], [5.0, -5.0, z], [0.0, 5.0, z]];
        scene.meshes.push(triangle(at(0.3), BLUE));
        assert!(is_red(&scene, projection));
        scene.meshes.push(triangle(at(0.9), BLUE));
        assert!(!is_red(&scene, projection));
        let ends = [[-1.0, 0.0, 2.0], [1.0, 0.0, 2.0]];
        scene.tubes.push(Tube { ends, radius: 0.3, colour: RED });
        assert!(is_red(&scene, projection));
    }
}

#[test]
fn backs_are_seen_only_of_two_sided_meshes() {
    let clockwise = [[-5.0, -5.0, 0.0], [0.0, 5.0, 0.0], [5.0, -5.0, 0.0]];
    let mut mesh = triangle(clockwise, RED);
    let mut seen = |two_sided| {
        mesh.two_sided = two_sided;
        let scene = Scene { meshes: vec![mesh.clone()], ..Scene::default() };
        draw(&scene, 3, Background::Transparent).pixel(1, 1)
    };
    assert_eq!(seen(false), [0; 4]);
    let [r, g, b, opacity] = seen(true);
    assert!(r > 120 && g < 60 && b < 60 && opacity == 255, "a back is lit as well");
}

#[test]
fn a_hollow_is_darker_than_the_open() {
    // A floor, and the same floor at the bottom of a well.
    let square = |z: f64, r: f64| [[-r, -r, z], [r, -r, z], [r, r, z], [-r, r, z]];
    let floor = Mesh::new(square(-1.0, 0.3).to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
    let open = Scene { meshes: vec![floor.clone()], ..Scene::default() };
    let walls: Vec<_> = [square(-1.0, 0.31), square(1.0, 0.31)].concat();
    let sides =
        (0..4).flat_map(|k| [[k, (k + 1) % 4, k + 4], [(k + 1) % 4, (k + 1) % 4 + 4, k + 4]]);
    let walls = Mesh { two_sided: true, ..Mesh::new(walls, sides.collect()) };
    let well = Scene { meshes: vec![floor, walls], ..Scene::default() };
    let middle = |scene| u32::from(draw(scene, 21, Background::White).pixel(10, 10)[0]);
    assert!(middle(&well) * 3 < middle(&open) * 2, "{} {}", middle(&well), middle(&open));
}

#[test]
fn empty_tiny_and_flat_scenes_are_pictures_too() {
    let white =
        |scene: &Scene| draw(scene, 5, Background::White).pixels().iter().all(|p| *p == [255; 4]);
    assert!(white(&Scene::default()));
    assert!(Scene::default().bounds().is_none());
    let line = [[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let point = [[0.3; 3]; 3];
    let flat = [line, point].map(|corners| triangle(corners, RED)).to_vec();
    assert!(white(&Scene { meshes: flat, ..Scene::default() }));
    assert!(white(&ball([0.0; 3], 0.0, RED)));
    // Smaller than the distance of two samples, and farther away than doubles resolve.
    draw(&ball([0.0; 3], 1e-300, RED), 5, Background::White);
    draw(&ball([1e90, 0.0, -1e90], 1e89, RED), 5, Background::White);
    let huge = triangle([[-1e99, -1e99, 0.0], [1e99, -1e99, 0.0], [0.0, 1e99, 0.0]], RED);
    let huge = Scene { meshes: vec![huge], ..Scene::default() };
    assert_ne!(draw(&huge, 5, Background::White).pixel(2, 2), [255; 4]);
    let same = Tube { ends: [[0.0; 3]; 2], radius: 0.2, colour: RED };
    assert!(!white(&Scene { tubes: vec![same], ..Scene::default() }));
}

#[test]
fn units_of_length_do_not_matter() {
    let scene = crowd();
    let size = Size::new(60, 40).unwrap();
    let drawn = |scene: &Scene, projection| {
        let camera = scene.camera(View::ThreeQuarter, projection, size).unwrap();
        scene.render(&camera, size, Background::White).unwrap()
    };
    for projection in [Projection::Perspective, Projection::Orthographic] {
        let expected = drawn(&scene, projection);
        for power in [-280, -160, -40, 40, 160, 280] {
            let found = drawn(&scene.scaled(2f64.powi(power)), projection);
            assert!(found == expected, "2^{power}");
        }
    }
}

#[test]
fn what_reaches_behind_the_eye_is_cut_off() {
    // A floor under the eye that goes far behind it: ground below the horizon, sky above.
    let floor = [[-1e6, -1.0, -1e6], [1e6, -1.0, -1e6], [0.0, -1.0, 1e6]];
    let mut scene = Scene { meshes: vec![triangle(floor, RED)], ..Scene::default() };
    let colour = BLUE;
    scene.tubes.push(Tube { ends: [[3.0, 1.0, -50.0], [3.0, 1.0, 500.0]], radius: 0.2, colour });
    scene.balls.push(Ball { centre: [0.0, 0.0, 10.0], radius: 3.0, colour });
    let camera = Camera { height: 20.0, ..above(Projection::Perspective) };
    let picture = scene.render(&camera, Size::new(40, 40).unwrap(), Background::White).unwrap();
    assert_eq!(picture.pixel(5, 5), [255; 4]);
    let [r, g, ..] = picture.pixel(20, 38);
    assert!(r > 100 && g < 100);
}

#[test]
fn a_fitted_camera_sees_the_whole_scene_in_the_middle_and_no_more() {
    let bounds = [[0.0, 0.0, 0.0], [30.0, 20.0, 10.0]];
    let mut scene = Scene::default();
    scene.add_box(bounds, 0.01, RED);
    assert_eq!(scene.tubes.len(), 12);
    let views = [
        View::Front,
        View::Back,
        View::Left,
        View::Right,
        View::Top,
        View::Bottom,
        View::ThreeQuarter,
    ];
    for projection in [Projection::Perspective, Projection::Orthographic] {
        for view in views {
            let size = Size::new(160, 120).unwrap();
            let camera = scene.camera(view, projection, size).unwrap();
            let picture = scene.render(&camera, size, Background::Transparent).unwrap();
            let ink: Vec<usize> = (0..160 * 120).filter(|&k| picture.pixels()[k][3] > 0).collect();
            let span = |of: fn(usize) -> usize| {
                let all = ink.iter().map(|&k| of(k));
                (all.clone().min().unwrap(), all.max().unwrap())
            };
            let (left, right) = span(|k| k % 160);
            let (top, bottom) = span(|k| k / 160);
            assert!(left > 0 && right < 159 && top > 0 && bottom < 119, "{view:?} is cut");
            let filled = ((right - left) as f64 / 160.0).max((bottom - top) as f64 / 120.0);
            assert!(filled > 0.9, "{view:?} {projection:?} fills {filled}");
            // Perspective leaves the side that has room a little off the middle.
            let off = [(left + right).abs_diff(159), (top + bottom).abs_diff(119)];
            let [near, far] = [off[0].min(off[1]), off[0].max(off[1])];
            assert!(near <= 2 && far <= 10, "{view:?} {projection:?}: {off:?}");
        }
    }
}

#[test]
fn cameras_that_cannot_see_are_refused() {
    let good = above(Projection::Perspective);
    let size = Size::new(4, 4).unwrap();
    let bad = [
        Camera { target: good.eye, ..good },
        Camera { up: [0.0; 3], ..good },
        Camera { up: [0.0, 0.0, -2.0], ..good },
        Camera { eye: [f64::NAN, 0.0, 1.0], ..good },
        Camera { eye: [0.0, 0.0, f64::INFINITY], ..good },
        Camera { height: 0.0, ..good },
        Camera { height: f64::NAN, ..good },
    ];
    for camera in bad {
        let result = Scene::default().render(&camera, size, Background::White);
        assert!(matches!(result, Err(RenderError::Camera(_))), "{camera:?}");
    }
    let of_ball = |centre, radius| Scene {
        balls: vec![Ball { centre, radius, colour: RED }],
        ..Scene::default()
    };
    for (scene, is_seen) in [
        (Scene::default(), true),
        (of_ball([5.0; 3], 0.0), true),
        (of_ball([f64::NAN; 3], 1.0), false),
        (of_ball([0.0; 3], f64::INFINITY), false),
    ] {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let camera = scene.camera(View::Front, projection, size);
            assert_eq!(camera.is_ok(), is_seen, "{camera:?}");
            if let Ok(camera) = camera {
                scene.render(&camera, size, Background::White).unwrap();
            }
        }
    }
    for (width, height) in [(0, 5), (5, 0), (Size::MAX_SIDE + 1, 5)] {
        assert!(matches!(Size::new(width, height), Err(RenderError::Size { .. })));
    }
}

#[test]
fn scenes_that_contradict_themselves_are_refused() {
    let good = triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], RED);
    let refused = |change: fn(&mut Mesh)| {
        let mut mesh = good.clone();
        change(&mut mesh);
        let scene = Scene { meshes: vec![mesh], ..Scene::default() };
        let size = Size::new(4, 4).unwrap();
        scene.render(&above(Projection::Orthographic), size, Background::White).unwrap_err()
    };
    assert!(matches!(refused(|m| m.triangles[0][1] = 3), RenderError::Index { vertex: 3, .. }));
    let error = refused(|m| m.normals = Some(Vec::new()));
    assert!(matches!(error, RenderError::Attribute { what: "normals", got: 0, .. }));
    let error = refused(|m| m.colours = Colours::Vertex(vec![RED]));
    assert!(matches!(error, RenderError::Attribute { what: "colours", got: 1, .. }));
    let error = refused(|m| m.positions[0][2] = f64::NAN);
    assert!(matches!(error, RenderError::OutOfRange { what: "mesh", index: 0 }));
    assert!(matches!(refused(|m| m.opacity = 1.5), RenderError::OutOfRange { .. }));
    for radius in [-1.0, f64::NAN] {
        let size = Size::new(4, 4).unwrap();
        let error = ball([0.0; 3], radius, RED)
            .render(&above(Projection::Orthographic), size, Background::White)
            .unwrap_err();
        assert!(matches!(error, RenderError::OutOfRange { what: "ball", index: 0 }));
    }
}
