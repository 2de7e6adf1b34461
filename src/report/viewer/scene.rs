//! Turn a movement, its pressures, map and trees into the data of a page, small enough to be part of it.

use serde::Serialize;
use serde_json::{Value, json};

use super::frames::Frames;
use super::text::{Packed, base64};
use crate::files::import::Surface;
use crate::files::moved_body::{MovedBody, NUMBERS};
use crate::stages::agent::Shape;
use crate::stages::body_map::BodyMap;
use crate::stages::schema::Sample;
use crate::stages::tree::{Edge, Truth};

/// Everything that is shown of one movement.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    /// What tells it from the others of its page, such as `p = 0.9`.
    pub name: String,
    /// Times that are shown.
    pub frames: Frames,
    /// The sample of each frame in the recording; `None` if no sample was left out before.
    pub times: Option<Vec<usize>>,
    /// Time between two samples, s; `None` if it is not known.
    pub interval: Option<f64>,
    /// M.
    pub sensors: usize,
    /// Whether it is a body at rest, which feels nothing.
    pub is_still: bool,
    /// Pressures of all sensors at one frame after the other.
    pub touch: Vec<f32>,
    /// The body; `None` for that of one's own data.
    pub body: Option<MovedBody>,
    /// The surfaces of solids that are not drawn as the shapes that they are for the engine.
    pub surfaces: Vec<Surface>,
    /// Place of each sensor on the map, which has all of them.
    pub map: Option<BodyMap>,
    /// True parts and tree.
    pub truth: Option<Parts>,
    /// Estimated parts and tree.
    pub estimate: Option<Parts>,
}

/// Parts and the tree over them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Parts {
    /// Part of each sensor; `None` for one that was left out.
    pub of: Vec<Option<usize>>,
    /// Edges of the tree.
    pub tree: Vec<TreeEdge>,
    /// What the parts are called, by number, where they have names.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub names: Vec<String>,
}

/// An edge between two parts.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct TreeEdge {
    /// The one end.
    pub child: usize,
    /// The other end.
    pub parent: usize,
    /// Bootstrap support or probability, 0 to 1, where the method says so.
    pub support: Option<f64>,
}

impl Parts {
    /// The true ones.
    pub(crate) fn of_truth(Truth { labels, tree, .. }: &Truth) -> Self {
        let edge = |&(child, parent): &(usize, usize)| TreeEdge { child, parent, support: None };
        let of = labels.iter().copied().map(Some).collect();
        Self { of, tree: tree.iter().map(edge).collect(), names: Vec::new() }
    }

    /// Those of one posterior sample, which says nothing of how sure an edge is.
    pub(crate) fn of_sample(Sample { labels, tree, .. }: &Sample) -> Self {
        let edge = |&Edge { child, parent }: &Edge| TreeEdge { child, parent, support: None };
        let of = labels.iter().copied().map(Some).collect();
        Self { of, tree: tree.iter().map(edge).collect(), names: Vec::new() }
    }
}

impl Scene {
    /// The data, as `viewer.js` reads them.
    pub(crate) fn data(&self) -> Value {
        let Self { name, frames, times, interval, sensors, body, map, truth, estimate, .. } = self;
        json!({
            "name": name,
            "frames": frames.count,
            "still": self.is_still,
            "sensors": sensors,
            "start": frames.first as f64 * interval.unwrap_or(1.0),
            "step": frames.every as f64 * interval.unwrap_or(1.0),
            "times": times.as_ref().map(|times| {
                times.iter().map(|&sample| sample as f64 * interval.unwrap_or(1.0)).collect::<Vec<_>>()
            }),
            "unit": if interval.is_some() { "s" } else { "samples" },
            "touch": self.pressures(),
            "body": body.as_ref().map(|body| self.moved(body)),
            "map": map.as_ref().map(places),
            "truth": truth,
            "estimate": estimate,
        })
    }

    /// Pressures as bytes, by frames: 255 times the root of their share of the greatest, since the root of a pressure in a fluid is a
    /// speed.
    fn pressures(&self) -> Value {
        let mut shown: Vec<f32> = self.touch.iter().map(|pressure| pressure.abs()).collect();
        let mut sorted: Vec<f32> = shown.iter().copied().filter(|pressure| *pressure > 0.0).collect();
        sorted.sort_by(f32::total_cmp);
        // A few that are far greater than the others would leave those without a colour.
        let greatest = sorted.get(sorted.len() * 995 / 1000).copied().unwrap_or(1.0);
        shown.iter_mut().for_each(|pressure| *pressure = 255.0 * (*pressure / greatest).sqrt().min(1.0));
        // A cast of NaN is 0.
        let bytes: Vec<u8> = shown.iter().map(|level| level.round() as u8).collect();
        json!({ "greatest": greatest, "data": base64(&bytes) })
    }

    /// Shapes, sensors and poses. Places are from the mean of the centres, so that the body stays in view.
    fn moved(&self, MovedBody { shapes, sites, poses }: &MovedBody) -> Value {
        // Pose 0 is that before the first sample.
        let poses: Vec<&[[f32; NUMBERS]]> = self
            .frames
            .samples()
            .map(|sample| &poses[(sample + 1) * shapes.len()..][..shapes.len()])
            .collect();
        let centred = |poses: &&[[f32; NUMBERS]]| -> Vec<f64> {
            let mean = [0, 1, 2]
                .map(|axis| poses.iter().map(|pose| f64::from(pose[axis])).sum::<f64>() / poses.len() as f64);
            poses.iter().flat_map(|pose| [0, 1, 2].map(|axis| f64::from(pose[axis]) - mean[axis])).collect()
        };
        let centres: Vec<f64> = poses.iter().flat_map(centred).collect();
        let solid = |(at, own): (usize, &Shape)| {
            self.surfaces.iter().find(|surface| surface.part == at).map_or_else(|| shape(own), mesh)
        };
        let turns = poses.iter().flat_map(|poses| poses.iter().flat_map(|pose| &pose[3..]));
        json!({
            "solids": shapes.iter().enumerate().map(solid).collect::<Vec<_>>(),
            "solid": sites.iter().map(|site| site.part).collect::<Vec<_>>(),
            "places": Packed::of(sites.iter().flat_map(|site| site.position)),
            "normals": Packed::of(sites.iter().flat_map(|site| site.normal)),
            "centres": Packed::of(centres.iter().copied()),
            "turns": Packed::of(turns.map(|&number| f64::from(number))),
        })
    }
}

fn shape(shape: &Shape) -> Value {
    match *shape {
        Shape::Cylinder { radius, length } => {
            json!({ "kind": "cylinder", "radius": radius, "length": length })
        }
        Shape::Capsule { radius, length } => json!({ "kind": "capsule", "radius": radius, "length": length }),
        Shape::Sphere { radius } => json!({ "kind": "capsule", "radius": radius, "length": 0.0 }),
        Shape::Box { sides } => json!({ "kind": "box", "sides": sides }),
    }
}

fn mesh(surface: &Surface) -> Value {
    json!({ "kind": "mesh", "corners": Packed::of(surface.triangles.iter().flatten().flatten().copied()) })
}

/// The first three dimensions of a map, from its mean; dimensions that it has not are 0.
fn places(map: &BodyMap) -> Packed {
    let (points, dims) = (map.points(), map.dims);
    let known = |axis: usize| {
        (0..points).filter_map(move |at| Some(map.coordinates[at * dims + axis]).filter(|x| x.is_finite()))
    };
    let mean = |axis: usize| known(axis).sum::<f64>() / known(axis).count().max(1) as f64;
    let means: Vec<f64> = (0..dims.min(3)).map(mean).collect();
    let means = &means;
    let place = move |at: usize| {
        (0..3).map(move |axis| means.get(axis).map_or(0.0, |mean| map.coordinates[at * dims + axis] - mean))
    };
    Packed::of((0..points).flat_map(place))
}
