//! Body maps drawn from the generative model of the DPGMM-LJ itself, with a known tree.
#![allow(unreachable_pub, reason = "tests, benchmarks and examples compile it for themselves")]

use bodyschema::numerics::rng::Stream;
use bodyschema::stages::body_map::BodyMap;
use bodyschema::stages::mixture::{Gaussian, NormalInverseWishart, standard_normal};
use bodyschema::stages::schema::collapsed_cost;
use bodyschema::stages::tree::Truth;
use bodyschema::stages::tree::prim;
use nalgebra::{DMatrix, DVector};
use rand::RngExt;

/// Parts of every synthetic body.
pub const PARTS: usize = 5;

/// Points of every part.
pub const POINTS: usize = 168;

/// A tree over [`PARTS`] nodes, uniform over all 125 of them, as (child, parent) pairs with parents first.
pub fn random_tree(rng: &mut Stream) -> Vec<(usize, usize)> {
    // By the Prüfer code; then rooted at node 0.
    let code: Vec<usize> = (0..PARTS - 2).map(|_| rng.random_range(0..PARTS)).collect();
    let mut degree = [1; PARTS];
    code.iter().for_each(|&node| degree[node] += 1);
    let mut edges = Vec::new();
    for &node in &code {
        let leaf = degree.iter().position(|&d| d == 1).expect("a tree has leaves");
        edges.push((leaf, node));
        degree[leaf] = 0;
        degree[node] -= 1;
    }
    let mut last = (0..PARTS).filter(|&node| degree[node] == 1);
    edges.push((last.next().expect("two are left"), last.next().expect("two are left")));

    let mut reached = vec![0];
    let mut rooted = Vec::new();
    while rooted.len() < edges.len() {
        for &(a, b) in &edges {
            let (child, parent) = if reached.contains(&a) { (b, a) } else { (a, b) };
            if reached.contains(&parent) && !reached.contains(&child) {
                reached.push(child);
                rooted.push((child, parent));
            }
        }
    }
    rooted
}

/// A synthetic body.
pub struct Body {
    /// Its map.
    pub map: BodyMap,
    /// The parts and tree that it was drawn from.
    pub truth: Truth,
    /// Whether that tree is the minimum spanning tree of the true components under collapsed weights: where
    /// it is not, another tree is likelier than the one that the body was drawn from, and no sampler can
    /// be expected to find the latter.
    pub identifiable: bool,
}

/// The least adjusted Rand index at which a tree is judged: components that overlap by design cannot be told
/// apart to the last point.
pub const ELIGIBLE_ARI: f64 = 0.95;

/// A body in `dims` dimensions.
///
/// Each joint is a draw of its parent component, and its child's centre is placed so that the joint is a
/// draw of the child, too (equations 13 and 14 with a flat prior on the centres). `separation` stretches
/// both offsets: at 1 it is the model itself, at 0 all centres coincide.
pub fn body(dims: usize, separation: f64, rng: &mut Stream) -> Body {
    let freedom = dims as f64 + 5.0;
    let scale = DMatrix::identity(dims, dims) * 4.0;
    let shape = NormalInverseWishart::new(DVector::zeros(dims), 1.0, scale, freedom)
        .expect("the identity is positive definite");
    let tree = random_tree(rng);
    let roots: Vec<DMatrix<f64>> = (0..PARTS)
        .map(|_| shape.draw(rng).covariance().cholesky().expect("a covariance is positive definite").unpack())
        .collect();
    let mut centres = vec![DVector::zeros(dims); PARTS];
    for &(child, parent) in &tree {
        let joint = &centres[parent] + separation * &roots[parent] * standard_normal(dims, rng);
        centres[child] = joint + separation * &roots[child] * standard_normal(dims, rng);
    }
    let components: Vec<Gaussian> = centres
        .into_iter()
        .zip(roots)
        .map(|(centre, root)| {
            // Σ = L Lᵀ has the precision Pᵀ P with P = L⁻¹.
            Gaussian::new(centre, root.try_inverse().expect("a Cholesky factor is regular"))
        })
        .collect();
    let labels: Vec<usize> = (0..PARTS * POINTS).map(|i| i / POINTS).collect();
    let coordinates =
        labels.iter().flat_map(|&part| components[part].draw(rng).as_slice().to_vec()).collect();

    let undirected = |a: usize, b: usize| (a.min(b), a.max(b));
    let nodes: Vec<usize> = (0..PARTS).collect();
    let moments: Vec<_> = components.iter().map(Gaussian::moments).collect();
    let cost =
        |s: usize, c: usize| collapsed_cost(&moments[s], &moments[c]).expect("components are far from flat");
    let mut likeliest: Vec<_> =
        prim(&nodes, cost).iter().map(|edge| undirected(edge.child, edge.parent)).collect();
    let mut drawn: Vec<_> = tree.iter().map(|&(child, parent)| undirected(child, parent)).collect();
    likeliest.sort_unstable();
    drawn.sort_unstable();
    Body {
        map: BodyMap { dims, coordinates },
        truth: Truth::new(labels, tree),
        identifiable: likeliest == drawn,
    }
}
