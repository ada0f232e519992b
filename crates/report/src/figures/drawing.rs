//! The drawing model that pages and figures share: outlines of bodies, joints as symbols that move
//! with a body, wheels and applied forces. A page draws the model at any time of a run. An SVG
//! figure shows the model at one time. Positions that do not move with a body are given for each
//! frame of the run.
//!
//! All points of the model have coordinates in the frame of a body. The `Projection` of the model
//! converts them to points of the picture.

mod point;
#[cfg(test)]
mod tests;
mod wheel;

use model::space::{difference, norm};
use model::{Bodies, BodyRef, ConstraintId, Mechanism, Scratch, SpaceKind, System};
use serde::Serialize;

use super::geometry::{Site, site, sites, turned_back};
use super::outline::{double_area, hull};
use super::projection::Projection;
use super::symbol::{SPRING, Shapes, Symbol};
use crate::channel::{Channel, FewDigits};
use crate::recording::Frame;
pub(crate) use point::{Curves, Point};
pub(crate) use wheel::DrawnWheel;

/// Number of frames of the run at which the program tests whether a point moves with a body.
const PROBES: usize = 9;

/// A point moves with a body if the coordinates of the point in the body change by at most this
/// fraction of the size of the picture.
const FIXED: f64 = 1e-9;

/// Index of the ground in lists of bodies.
const GROUND: isize = -1;

/// A point in the frame of a body.
type BodyPoint = (isize, Point);

/// A body.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DrawnBody {
    pub(crate) name: String,
    /// Points in the frame of the body (m), whose convex hull is drawn as the body: the centre of
    /// mass and the points of joints and forces. In the plane, only the corners of the hull.
    pub(crate) outline: Vec<Point>,
    /// Origin of the frame in which the scene describes the body, if it differs from the centre of
    /// mass.
    #[serde(skip_serializing_if = "Option::is_none")]
    frame: Option<Point>,
    /// Position of the centre of mass, orientation and velocities, with the names of
    /// [`SpaceKind::columns`].
    #[serde(flatten)]
    curves: Curves,
}

/// Position of a drawn item.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum Place {
    /// Fixed in the frame of a body.
    Of { b: isize, p: Point },
    /// A position that is given for each frame of the run.
    Free(Curves),
}

/// Direction of a drawn item.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum Heading {
    /// A direction at this angle in a body (rad).
    Of { b: isize, a: FewDigits },
    /// An angle that is given for each frame of the run.
    Free { a: Channel },
    /// In space: this direction, as a unit vector.
    Along(Place),
}

/// A joint or drive.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DrawnSite {
    pub(crate) symbol: &'static str,
    pub(crate) place: Place,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) axis: Option<Heading>,
    /// Second part of a symbol: the far end of a rod, the block of a guide, or the part that slides
    /// on a plane.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) end: Option<Place>,
    pub(crate) grounded: bool,
    pub(crate) bodies: Vec<isize>,
    /// Rolling circles.
    pub(crate) wheels: Vec<DrawnWheel>,
}

/// An applied force.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DrawnForce {
    pub(crate) name: String,
    #[serde(rename = "type")]
    pub(crate) kind: &'static str,
    pub(crate) points: Vec<BodyPoint>,
    pub(crate) bodies: Vec<isize>,
}

/// A marker.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DrawnMarker {
    pub(crate) name: String,
    pub(crate) b: isize,
    /// Position relative to the centre of mass of the body, in the axes of the body (m).
    pub(crate) p: Point,
    /// Angle of the marker's axes in the body (rad).
    a: FewDigits,
}

/// Everything that is drawn.
#[derive(Clone, Debug, Serialize)]
pub struct DrawingModel {
    /// The projection of a mechanism in space. It is omitted in the plane, because scripts do not
    /// need it.
    #[serde(skip_serializing_if = "Projection::is_plane")]
    pub(crate) view: Projection,
    pub(crate) bodies: Vec<DrawnBody>,
    pub(crate) sites: Vec<DrawnSite>,
    pub(crate) forces: Vec<DrawnForce>,
    pub(crate) markers: Vec<DrawnMarker>,
    /// Bodies in the order of drawing, starting with the largest.
    pub(crate) order: Vec<usize>,
    shapes: Shapes,
    spring: &'static [[f64; 2]],
    /// Poses at the first frame of the run.
    #[serde(skip)]
    poses: Bodies,
}

impl DrawnSite {
    /// Whether the item slides on a rail.
    pub(crate) fn is_guided(&self) -> bool {
        matches!(self.symbol, "block" | "slot")
    }

    /// Position of the symbol. A block is drawn at its present position.
    pub(crate) fn shown(&self) -> &Place {
        match &self.end {
            Some(end) if self.symbol != "rod" => end,
            _ => &self.place,
        }
    }
}

/// Positions in the picture at the first frame of the run (m and rad).
impl DrawingModel {
    /// The centre of mass of a body; the origin for the ground.
    pub(crate) fn centre(&self, body: isize) -> [f64; 2] {
        self.held(body, Point::default())
    }

    /// A point in the frame of a body.
    pub(crate) fn held(&self, body: isize, point: Point) -> [f64; 2] {
        let at = point.at();
        self.view.flat(match usize::try_from(body) {
            Ok(k) => self.poses.to_global(k, at),
            Err(_) => at,
        })
    }

    /// The position of an item.
    pub(crate) fn at(&self, place: &Place) -> [f64; 2] {
        match place {
            Place::Of { b, p } => self.held(*b, *p),
            Place::Free(curves) => self.view.flat(curves.first()),
        }
    }

    /// The corners of the outline of a body relative to its centre of mass, before the rotation by
    /// the returned angle.
    pub(crate) fn silhouette(&self, body: usize) -> (Vec<[f64; 2]>, f64) {
        let points = self.bodies[body].outline.iter();
        if self.view.is_plane() {
            let flat = points.map(|p| self.view.flat(p.at()));
            return (flat.collect(), self.poses.angle(body));
        }
        let flat = points.map(|p| self.view.flat(self.poses.turned(body, p.at())));
        (hull(&flat.collect::<Vec<_>>()), 0.0)
    }

    /// The axis of a symbol in space. The projection shortens the axis.
    pub(crate) fn axis(&self, site: &DrawnSite) -> Option<[f64; 2]> {
        let Some(Heading::Along(direction)) = &site.axis else {
            return None;
        };
        Some(self.view.flat(match direction {
            Place::Of { b, p } => match usize::try_from(*b) {
                Ok(k) => self.poses.turned(k, p.at()),
                Err(_) => p.at(),
            },
            Place::Free(curves) => curves.first(),
        }))
    }

    /// The angle of a symbol.
    pub(crate) fn angle(&self, site: &DrawnSite) -> f64 {
        match &site.axis {
            Some(Heading::Of { b, a }) => {
                let turn = usize::try_from(*b).map_or(0.0, |k| self.poses.angle(k));
                turn + a.0
            }
            Some(Heading::Free { a }) => a.first(),
            Some(Heading::Along(_)) => self.axis(site).map_or(0.0, |[x, y]| y.atan2(x)),
            None => 0.0,
        }
    }
}

/// A mechanism with the frames of its bodies.
pub struct Stage<'a> {
    /// The mechanism, or the drawn part of the mechanism.
    pub mechanism: &'a Mechanism,
    /// For each drawn body, its index in the list of all bodies.
    pub bodies: &'a [usize],
    /// For each coordinate of the drawn part, its index in the list of all coordinates.
    pub coordinates: &'a [usize],
    /// The rows of the run.
    pub frames: &'a [Frame],
}

impl Stage<'_> {
    /// Returns the drawing of the bodies and joints of this part. The drawing includes the forces
    /// that act on these bodies and the markers on these bodies in `whole`.
    #[must_use]
    pub fn drawing(&self, whole: &Mechanism) -> DrawingModel {
        let forces = DrawnForce::all(whole, self.bodies);
        let probes = self.probes();
        let size = self.size();
        let sites = self.mechanism.layout().constraint_ids();
        let mut drawing = DrawingModel {
            view: Projection::of(whole),
            sites: sites.map(|id| self.site(id, &probes, size)).collect(),
            bodies: self
                .outlines(&forces)
                .into_iter()
                .zip(self.states())
                .enumerate()
                .map(|(k, (outline, states))| self.body(k, outline, &states))
                .collect(),
            forces,
            markers: DrawnMarker::all(whole, self.bodies),
            order: Vec::new(),
            shapes: Shapes,
            spring: &SPRING,
            poses: self.frames.first().map_or_else(
                || Bodies::at(self.mechanism.space(), &[]),
                |frame| self.mechanism.frames().poses(&self.q(frame)),
            ),
        };
        let mut order: Vec<(usize, f64)> = (0..drawing.bodies.len())
            .filter(|_| !self.frames.is_empty())
            .map(|k| (k, double_area(&drawing.silhouette(k).0)))
            .collect();
        order.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        drawing.order = order.into_iter().map(|(k, _)| k).collect();
        drawing
    }

    /// Outlines of the bodies. Each outline is in the frame of its body.
    fn outlines(&self, forces: &[DrawnForce]) -> Vec<Vec<Point>> {
        let space = self.mechanism.space();
        let mut points = vec![vec![[0.0; 3]]; self.bodies.len()];
        let held = self.mechanism.layout().constraint_ids();
        let held = held.flat_map(|id| self.mechanism.points(id));
        for (body, point) in held.filter_map(|(b, p)| Some((b.moving()?, p))) {
            points[body].push(self.told(BodyRef::Body(body), point));
        }
        for &(body, point) in forces.iter().flat_map(|f| &f.points) {
            if let Ok(k) = usize::try_from(body) {
                points[k].push(point.at());
            }
        }
        let outline = |mut points: Vec<[f64; 3]>| {
            if space == SpaceKind::Space3 {
                points.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
                points.dedup();
                return points;
            }
            let flat: Vec<[f64; 2]> = points.iter().map(|&[x, y, _]| [x, y]).collect();
            hull(&flat).into_iter().map(|[x, y]| [x, y, 0.0]).collect()
        };
        let outlines = points.into_iter().map(outline);
        outlines
            .map(|points| points.iter().map(|p| Point::new(space, *p)).collect())
            .collect()
    }

    /// Converts a vector from the axes of the coordinates of a body to the axes of its frame.
    fn told(&self, body: BodyRef, own: [f64; 3]) -> [f64; 3] {
        self.mechanism.frames().vector(body, own)
    }

    /// Coordinates of the drawn part at a frame of the run, with the unwrapped angles of the
    /// joints.
    fn q(&self, frame: &Frame) -> Vec<f64> {
        self.coordinates.iter().map(|&k| frame.q[k]).collect()
    }

    /// Velocities of the drawn bodies at a frame of the run.
    fn v(&self, frame: &Frame) -> Vec<f64> {
        let (own, space) = (self.bodies.iter(), self.mechanism.space());
        own.flat_map(|&k| frame.v[space.columns_of(k)].iter().copied())
            .collect()
    }

    fn posed(&self, frame: &Frame) -> Scratch {
        let mut s = self.mechanism.scratch();
        self.mechanism.pose(frame.t, &self.q(frame), &mut s);
        s
    }

    fn probes(&self) -> Vec<Probe> {
        let n = self.frames.len();
        let count = n.min(PROBES);
        let places = (0..count).map(|k| k * (n - 1) / (count - 1).max(1));
        places
            .map(|k| {
                let scratch = self.posed(&self.frames[k]);
                Probe {
                    sites: sites(self.mechanism, &scratch),
                    scratch,
                }
            })
            .collect()
    }

    /// Extent of all centres of mass over the run (m).
    fn size(&self) -> f64 {
        let space = self.mechanism.space();
        let mut range = vec![[f64::INFINITY, f64::NEG_INFINITY]; space.n_translations()];
        for frame in self.frames {
            for &k in self.bodies {
                for (axis, [low, high]) in range.iter_mut().enumerate() {
                    let x = frame.q[space.coordinates(k).start + axis];
                    (*low, *high) = (low.min(x), high.max(x));
                }
            }
        }
        let reach = |[low, high]: [f64; 2]| low.abs().max(high.abs());
        range.into_iter().map(reach).fold(1e-12, f64::max)
    }

    /// For each body, the states of the centre of mass at all frames of the run.
    fn states(&self) -> Vec<Vec<Vec<f64>>> {
        let (bodies, frames) = (self.mechanism.bodies(), self.mechanism.frames());
        let mut states = vec![Vec::with_capacity(self.frames.len()); bodies.len()];
        for frame in self.frames {
            let (q, v) = (self.q(frame), self.v(frame));
            for (k, own) in states.iter_mut().enumerate() {
                let state = frames.point(k, bodies[k].centre(), &q, &v);
                own.push(state.numbers().collect());
            }
        }
        states
    }

    fn body(&self, k: usize, outline: Vec<Point>, states: &[Vec<f64>]) -> DrawnBody {
        let body = &self.mechanism.bodies()[k];
        let space = self.mechanism.space();
        let origin = self.told(BodyRef::Body(k), body.from_centre([0.0; 3]));
        let origin = Point::new(space, origin);
        DrawnBody {
            name: body.name.clone(),
            frame: (!body.is_centred()).then_some(origin),
            outline,
            curves: Curves::new(space.columns(), states),
        }
    }

    fn site(&self, id: ConstraintId, probes: &[Probe], size: f64) -> DrawnSite {
        let group = &self.mechanism.layout().groups[id.0];
        let symbol = probes.first().map_or(Symbol::Pin, |p| p.sites[id.0].symbol);
        let carriers: Vec<BodyRef> = group
            .bodies
            .iter()
            .copied()
            .chain([BodyRef::Ground])
            .collect();
        let space = self.mechanism.space();
        let place = |of: &dyn Fn(&Site) -> [f64; 3]| {
            self.place(id, probes, &carriers, FIXED * size, (of, &local))
        };
        let second = self.mechanism.points(id).get(1).copied();
        let is_apart = match symbol {
            Symbol::Rod | Symbol::Block { .. } | Symbol::Slot { .. } => true,
            Symbol::Pin | Symbol::Hinge { .. } => probes.iter().any(|p| {
                let Site { place, end, .. } = p.sites[id.0];
                space == SpaceKind::Space3 && norm(&difference(end, place)) > FIXED * size
            }),
            _ => false,
        };
        let end = is_apart.then(|| match second {
            Some((body, point)) => Place::Of {
                b: index(body),
                p: Point::new(space, self.told(body, point)),
            },
            None => place(&|site| site.end),
        });
        DrawnSite {
            symbol: symbol.name(),
            place: place(&|site| site.place),
            axis: symbol.axis().map(|_| match space {
                SpaceKind::Space3 => {
                    let axis = |site: &Site| site.symbol.axis().unwrap_or_default();
                    Heading::Along(self.place(id, probes, &carriers, FIXED, (&axis, &turned_back)))
                }
                _ => self.heading(id, probes, &carriers),
            }),
            end,
            grounded: probes.first().is_some_and(|p| p.sites[id.0].grounded),
            bodies: group.bodies.iter().map(|&b| index(b)).collect(),
            wheels: self.wheels(id, probes, size),
        }
    }

    /// Returns a point or a direction of a joint. If the point or direction is constant to within
    /// `known` in the axes of a body in `carriers`, it is given in the axes of the first such body.
    /// Otherwise, it is given for each frame of the run.
    fn place(
        &self,
        id: ConstraintId,
        probes: &[Probe],
        carriers: &[BodyRef],
        known: f64,
        (of, local): (&OfSite<'_>, &Local),
    ) -> Place {
        let space = self.mechanism.space();
        for &body in carriers {
            let mut seen = probes
                .iter()
                .map(|p| self.told(body, local(body, of(&p.sites[id.0]), &p.scratch)));
            let Some(first) = seen.next() else { break };
            if seen.all(|p| norm(&difference(p, first)) <= known) {
                return Place::Of {
                    b: index(body),
                    p: Point::new(space, first),
                };
            }
        }
        let all = self.every(id, |site| of(site)[space.forces()].to_vec());
        Place::Free(Curves::new(&space.columns()[space.forces()], &all))
    }

    fn heading(&self, id: ConstraintId, probes: &[Probe], carriers: &[BodyRef]) -> Heading {
        let angle = |site: &Site| {
            let [x, y, _] = site.symbol.axis().unwrap_or([1.0, 0.0, 0.0]);
            y.atan2(x)
        };
        for &body in carriers {
            let mut seen = probes
                .iter()
                .map(|p| angle(&p.sites[id.0]) - turn(body, &p.scratch));
            let Some(first) = seen.next() else { break };
            if seen.all(|a| (a - first).sin().abs() <= FIXED) {
                return Heading::Of {
                    b: index(body),
                    a: FewDigits(first),
                };
            }
        }
        let mut last: f64 = 0.0;
        let all = self.every(id, angle);
        // An axis has no sense, so its angle is determined only up to multiples of π. Each angle is
        // the value nearest to the previous angle.
        let unwound = all.into_iter().map(|a| {
            last = a + std::f64::consts::PI * ((last - a) / std::f64::consts::PI).round();
            last
        });
        let unwound: Vec<f64> = unwound.collect();
        Heading::Free {
            a: Channel::new(unwound.into_iter()),
        }
    }

    /// A property of a joint at all frames of the run.
    fn every<T>(&self, id: ConstraintId, of: impl Fn(&Site) -> T) -> Vec<T> {
        let frames = self.frames.iter();
        frames
            .map(|frame| {
                let s = self.posed(frame);
                of(&site(self.mechanism, id, &s))
            })
            .collect()
    }
}

/// The joints at one frame of the run.
struct Probe {
    scratch: Scratch,
    sites: Vec<Site>,
}

impl DrawnForce {
    /// The applied forces of a mechanism on bodies that are drawn.
    pub(crate) fn all(mechanism: &Mechanism, bodies: &[usize]) -> Vec<Self> {
        let place = |body: &BodyRef| drawn(bodies, *body);
        let drawn = mechanism.applied_forces().iter().filter_map(|f| {
            let points = f.points.iter();
            let space = mechanism.space();
            let frames = mechanism.frames();
            let held = points
                .map(|(body, p)| Some((place(body)?, Point::new(space, frames.vector(*body, *p)))));
            Some(Self {
                name: f.name.to_owned(),
                kind: f.spec.common.scene_type,
                points: held.collect::<Option<_>>()?,
                bodies: f.bodies.iter().map(place).collect::<Option<_>>()?,
            })
        });
        drawn.collect()
    }
}

impl DrawnMarker {
    /// The markers of a mechanism on the ground and on bodies that are drawn.
    fn all(mechanism: &Mechanism, bodies: &[usize]) -> Vec<Self> {
        let (space, frames) = (mechanism.space(), mechanism.frames());
        let markers = frames.observed().markers.iter();
        let all = markers.filter_map(|marker| {
            let own = marker.from_centre(mechanism.bodies());
            Some(Self {
                name: marker.name.clone(),
                b: drawn(bodies, marker.body)?,
                p: Point::new(space, frames.vector(marker.body, own)),
                a: FewDigits(marker.angle.unwrap_or_default()),
            })
        });
        all.collect()
    }
}

/// Index of a body among the drawn bodies.
fn drawn(bodies: &[usize], body: BodyRef) -> Option<isize> {
    match body {
        BodyRef::Ground => Some(GROUND),
        BodyRef::Body(k) => bodies.binary_search(&k).ok().map(|k| k as isize),
    }
}

fn index(body: BodyRef) -> isize {
    body.moving().map_or(GROUND, |k| k as isize)
}

/// A point or a direction of a joint, in ground axes.
type OfSite<'a> = dyn Fn(&Site) -> [f64; 3] + 'a;

/// Converts ground axes to the axes of the coordinates of a body.
type Local = dyn Fn(BodyRef, [f64; 3], &Scratch) -> [f64; 3];

/// Converts a global point to a point relative to the centre of mass of a body, in the axes of the
/// coordinates of the body.
fn local(body: BodyRef, point: [f64; 3], s: &Scratch) -> [f64; 3] {
    body.moving().map_or(point, |k| s.bodies.to_local(k, point))
}

fn turn(body: BodyRef, s: &Scratch) -> f64 {
    body.moving().map_or(0.0, |k| s.bodies.angle(k))
}
