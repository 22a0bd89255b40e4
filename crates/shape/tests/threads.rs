//! Shapes and filtrations have the same bytes for any number of threads.

use walpha_base::random::Random;
use walpha_shape::ladder::{Entry, Filtration, Ordered};
use walpha_shape::{AlphaShape, Engine, ShapeOptions, Torus, WeightedPoints, alpha_shape};

/// Sets of hundreds of points: fewer do not wake other threads.
const SETS: usize = 240;

/// Positions and weights, and a periodic box if there is one.
type Set = (Vec<[f64; 3]>, Vec<f64>, Option<Torus>);

/// Makes a set of approximately this many points.
type Make = fn(&mut Random, usize) -> Set;

const KINDS: [(&str, Make); 8] = [
    ("lattice", |random, count| without_weights(lattice(random, count))),
    ("weighted lattice with hidden points", |random, count| {
        let positions = lattice(random, count);
        let weights = positions.iter().map(|_| random.below(6) as f64).collect();
        (positions, weights, None)
    }),
    ("cospherical", |random, count| {
        let on_sphere = |_| {
            // All integer points with the same distance from the origin, and their halves.
            let [x, y, z] = [random.below(41), random.below(41), random.below(41)];
            let p = [x, y, z].map(|x| x as f64 - 20.0);
            let radius = [5.0, 10.0, 15.0][random.below(3)];
            let length = p.iter().map(|x| x * x).sum::<f64>().sqrt().max(1.0);
            p.map(|x| (x * radius / length).round())
        };
        without_weights((0..count).map(on_sphere).collect())
    }),
    ("coplanar subsets", |random, count| {
        let place = |_| {
            let mut p = [0; 3].map(|_| random.unit());
            p[random.below(3)] = random.below(4) as f64 / 4.0;
            p
        };
        without_weights((0..count).map(place).collect())
    }),
    ("near duplicates", |random, count| {
        let mut positions: Vec<[f64; 3]> = Vec::with_capacity(count);
        while positions.len() < count {
            let p = [0; 3].map(|_| 1.0 + random.unit());
            positions.extend([p, p, [p[0].next_up(), p[1], p[2]]]);
        }
        let weights = positions.iter().map(|_| 1e-3 * random.unit()).collect();
        (positions, weights, None)
    }),
    ("at random", |random, count| {
        let positions = (0..count).map(|_| [0; 3].map(|_| random.unit())).collect();
        (positions, (0..count).map(|_| 1e-3 * random.unit()).collect(), None)
    }),
    ("periodic lattice", |random, count| {
        let torus = Torus::new([10.0; 3]).expect("a box");
        let all = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from));
        let positions: Vec<_> = all.filter(|_| random.below(1000) < 700 + count / 8).collect();
        let weights = positions.iter().map(|_| 0.25 * random.below(3) as f64).collect();
        (positions, weights, Some(torus))
    }),
    ("flat", |random, count| {
        let place = |_| [random.below(30) as f64, random.below(30) as f64, 0.5];
        without_weights((0..count).map(place).collect())
    }),
];

fn lattice(random: &mut Random, count: usize) -> Vec<[f64; 3]> {
    let side = (1.5 * count as f64).cbrt().ceil() as usize;
    (0..count).map(|_| [0; 3].map(|_| random.below(side) as f64)).collect()
}

fn without_weights(positions: Vec<[f64; 3]>) -> Set {
    let weights = vec![0.0; positions.len()];
    (positions, weights, None)
}

/// A filtration with the order and pairs of its simplices, and a shape.
#[derive(PartialEq)]
struct Results {
    whole: AlphaShape,
    /// The shape at the median of the critical values, where exact equality decides about simplices.
    shape: AlphaShape,
    /// Vertices, ranks and bits of values of all simplices in order.
    simplices: Vec<(Vec<u32>, u32, [u64; 3], bool)>,
    values: Vec<u64>,
    order: Vec<u32>,
    components: Vec<[u32; 2]>,
    voids: Vec<[u32; 2]>,
    loops: Vec<[u32; 2]>,
    lasting: [Vec<u32>; 2],
    last: Option<u32>,
}

impl Results {
    fn new((positions, weights, torus): &Set) -> Self {
        let points = WeightedPoints::new(positions.clone(), weights.clone()).expect("points");
        let filtration = Filtration::on(*torus, points.clone()).expect("a filtration");
        let ordered = filtration.simplices().expect("an order");
        let values = ordered.values();
        let options = ShapeOptions::new(values[values.len() / 2]);
        let options = options.engine(Engine::Native).periodic(*torus);
        let shape = alpha_shape(points, &options).expect("a shape");
        Self::of(&filtration, &ordered, shape)
    }

    fn of(filtration: &Filtration, ordered: &Ordered<'_>, shape: AlphaShape) -> Self {
        let simplex = |entry: Entry<'_>| {
            let numbers = [entry.value, entry.regular, entry.interior].map(f64::to_bits);
            (entry.vertices.to_vec(), entry.rank, numbers, entry.gabriel)
        };
        let pairs = ordered.pairs();
        Self {
            whole: filtration.whole().clone(),
            shape,
            simplices: ordered.iter().map(simplex).collect(),
            values: ordered.values().iter().map(|value| value.squared().to_bits()).collect(),
            order: ordered.order().to_vec(),
            components: pairs.components.clone(),
            voids: pairs.voids.clone(),
            loops: ordered.loops().expect("loops").pairs.clone(),
            lasting: [pairs.lasting.clone(), pairs.lasting_voids.clone()],
            last: pairs.last,
        }
    }
}

#[test]
fn results_are_the_same_for_any_number_of_threads() {
    let mut random = Random::new(31);
    let pools = [1, 2, 3, 8].map(|threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
    });
    for round in 0..SETS {
        let (kind, make) = KINDS[round % KINDS.len()];
        let count = 300 + random.below(900);
        let set = make(&mut random, count);
        let [one, others @ ..] = pools.each_ref().map(|pool| pool.install(|| Results::new(&set)));
        assert!(one.simplices.len() > 60, "{kind}, set {round}");
        for (several, pool) in others.iter().zip(&pools[1..]) {
            let threads = pool.current_num_threads();
            assert!(*several == one, "{kind}, set {round}: {threads} threads differ from one");
        }
    }
}
