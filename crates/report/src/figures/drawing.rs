//! The single drawing model: outlines of bodies, joints as symbols that move with a body, wheels
//! and applied forces. A page draws it at any time of a run, an SVG figure at one time. Places that
//! do not move with a body are given frame by frame.

use joints::Pose;
use model::{BodyRef, ConstraintId, Mechanism, Scratch, System};
use serde::Serialize;

use super::geometry::{Site, flat, site, sites};
use super::outline::{double_area, hull};
use super::symbol::{SPRING, Shapes, Symbol};
use crate::channel::{Channel, Rounded};
use crate::recording::Frame;

/// Number of frames at which it is tested whether a place moves with a body.
const PROBES: usize = 9;

/// A place moves with a body if its coordinates in the body change by no more than this fraction of
/// the size of the picture.
const FIXED: f64 = 1e-9;

/// Index of the ground in lists of bodies.
const GROUND: isize = -1;

/// A point in the frame of a body.
type Held = (isize, Rounded, Rounded);

/// A body.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DrawnBody {
    pub(crate) name: String,
    /// Convex hull of its centre and of the points of joints and forces, in its frame (m).
    pub(crate) outline: Vec<[Rounded; 2]>,
    /// Origin of the frame in which the scene describes it, if that is not its centre.
    #[serde(skip_serializing_if = "Option::is_none")]
    frame: Option<[Rounded; 2]>,
    pub(crate) x: Channel,
    pub(crate) y: Channel,
    pub(crate) angle: Channel,
    vx: Channel,
    vy: Channel,
    omega: Channel,
}

/// Position of something.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum Place {
    /// Fixed in the frame of a body.
    Of { b: isize, p: [Rounded; 2] },
    /// Given separately for each frame of the run.
    Free { x: Channel, y: Channel },
}

/// Direction of something.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum Heading {
    /// At this angle in a body (rad).
    Of { b: isize, a: Rounded },
    /// Given separately for each frame of the run.
    Free { a: Channel },
}

/// A joint or drive.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DrawnSite {
    pub(crate) symbol: &'static str,
    pub(crate) place: Place,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) axis: Option<Heading>,
    /// The other end of a rod, or the block of a guide.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) end: Option<Place>,
    pub(crate) grounded: bool,
    pub(crate) bodies: Vec<isize>,
    /// Bodies with the radii of the pitch circles around their centres (m).
    pub(crate) wheels: Vec<(isize, Rounded)>,
}

/// An applied force.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DrawnForce {
    pub(crate) name: String,
    #[serde(rename = "type")]
    pub(crate) kind: &'static str,
    pub(crate) points: Vec<Held>,
    pub(crate) bodies: Vec<isize>,
}

/// A marker.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DrawnMarker {
    pub(crate) name: String,
    pub(crate) b: isize,
    /// Place relative to the centre of the body, in its axes (m).
    pub(crate) p: [Rounded; 2],
    /// Angle of its axes in the body (rad).
    a: Rounded,
}

/// Everything that is drawn.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DrawingModel {
    pub(crate) bodies: Vec<DrawnBody>,
    pub(crate) sites: Vec<DrawnSite>,
    pub(crate) forces: Vec<DrawnForce>,
    pub(crate) markers: Vec<DrawnMarker>,
    /// Bodies in the order of drawing, the largest first.
    pub(crate) order: Vec<usize>,
    shapes: Shapes,
    spring: &'static [[f64; 2]],
}

impl DrawnSite {
    /// Whether it slides on a rail.
    pub(crate) fn is_guided(&self) -> bool {
        matches!(self.symbol, "block" | "slot")
    }

    /// Position of its symbol; a block is drawn at the place to which it has moved.
    pub(crate) fn shown(&self) -> &Place {
        match &self.end {
            Some(end) if self.is_guided() => end,
            _ => &self.place,
        }
    }
}

/// Positions at the first frame (global, m and rad).
impl DrawingModel {
    /// The centre of a body; the origin for the ground.
    pub(crate) fn centre(&self, body: isize) -> [f64; 2] {
        self.held(body, [Rounded(0.0); 2])
    }

    /// A point in the frame of a body.
    pub(crate) fn held(&self, body: isize, [x, y]: [Rounded; 2]) -> [f64; 2] {
        match usize::try_from(body) {
            Ok(k) => {
                let body = &self.bodies[k];
                let pose = Pose::new(body.x.first(), body.y.first(), body.angle.first());
                pose.to_global([x.0, y.0])
            }
            Err(_) => [x.0, y.0],
        }
    }

    /// Global coordinates of a place.
    pub(crate) fn at(&self, place: &Place) -> [f64; 2] {
        match place {
            Place::Of { b, p } => self.held(*b, *p),
            Place::Free { x, y } => [x.first(), y.first()],
        }
    }

    /// The angle of a symbol.
    pub(crate) fn angle(&self, site: &DrawnSite) -> f64 {
        match &site.axis {
            Some(Heading::Of { b, a }) => {
                let turn = usize::try_from(*b).map_or(0.0, |k| self.bodies[k].angle.first());
                turn + a.0
            }
            Some(Heading::Free { a }) => a.first(),
            None => 0.0,
        }
    }
}

/// A mechanism with the frames of its bodies.
pub(crate) struct Stage<'a> {
    /// The mechanism, or the part of it that is drawn.
    pub(crate) mechanism: &'a Mechanism,
    /// Indices of its bodies among all bodies.
    pub(crate) bodies: &'a [usize],
    pub(crate) frames: &'a [Frame],
}

impl Stage<'_> {
    /// What is drawn of its bodies and joints, and of the forces and markers on them in `whole`.
    pub(crate) fn drawing(&self, whole: &Mechanism) -> DrawingModel {
        let forces = DrawnForce::all(whole, self.bodies);
        let probes = self.probes();
        let size = self.size();
        let outlines = self.outlines(&forces);
        let mut order: Vec<usize> = (0..outlines.len()).collect();
        order.sort_by(|&a, &b| double_area(&outlines[b]).total_cmp(&double_area(&outlines[a])));
        let sites = self.mechanism.layout().constraint_ids();
        DrawingModel {
            sites: sites.map(|id| self.site(id, &probes, size)).collect(),
            bodies: outlines
                .into_iter()
                .enumerate()
                .map(|(k, outline)| self.body(k, &outline))
                .collect(),
            forces,
            markers: DrawnMarker::all(whole, self.bodies),
            order,
            shapes: Shapes,
            spring: &SPRING,
        }
    }

    /// Outlines of the bodies, each in its frame.
    fn outlines(&self, forces: &[DrawnForce]) -> Vec<Vec<[f64; 2]>> {
        let mut points = vec![vec![[0.0; 2]]; self.bodies.len()];
        let held = self.mechanism.layout().constraint_ids();
        let held = held.flat_map(|id| self.mechanism.points(id));
        for (body, point) in held.filter_map(|(b, p)| Some((b.moving()?, p))) {
            points[body].push(flat(point));
        }
        for &(body, x, y) in forces.iter().flat_map(|f| &f.points) {
            if let Ok(k) = usize::try_from(body) {
                points[k].push([x.0, y.0]);
            }
        }
        points.iter().map(|p| hull(p)).collect()
    }

    /// Coordinates of its bodies in a frame.
    fn q(&self, frame: &Frame) -> Vec<f64> {
        let own = self.bodies.iter();
        let space = self.mechanism.space();
        own.flat_map(|&k| frame.q[space.coordinates(k)].iter().copied())
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

    /// Extent of all centres over the run (m).
    fn size(&self) -> f64 {
        let space = self.mechanism.space();
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for frame in self.frames {
            for &k in self.bodies {
                for (axis, [low, high]) in range.iter_mut().enumerate() {
                    let x = frame.q[space.coordinates(k).start + axis];
                    (*low, *high) = (low.min(x), high.max(x));
                }
            }
        }
        let reach = |[low, high]: [f64; 2]| low.abs().max(high.abs());
        range.map(reach).into_iter().fold(1e-12, f64::max)
    }

    fn body(&self, k: usize, outline: &[[f64; 2]]) -> DrawnBody {
        let at = self.bodies[k];
        let (space, first) = (self.mechanism.space(), self.mechanism.space().n_v() * at);
        let position = |dof: usize| {
            let all = self.frames.iter();
            Channel::new(all.map(move |f| space.position(&f.q, first + dof)))
        };
        let velocity = |dof: usize| Channel::new(self.frames.iter().map(move |f| f.v[first + dof]));
        let body = &self.mechanism.bodies()[k];
        let origin = flat(body.from_centre([0.0; 3])).map(Rounded);
        DrawnBody {
            name: body.name.clone(),
            frame: (!body.is_centred()).then_some(origin),
            outline: outline.iter().map(|p| p.map(Rounded)).collect(),
            x: position(0),
            y: position(1),
            angle: position(2),
            vx: velocity(0),
            vy: velocity(1),
            omega: velocity(2),
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
        let place =
            |of: &dyn Fn(&Site, &Scratch) -> [f64; 2]| self.place(id, probes, &carriers, size, of);
        let second = self.mechanism.points(id).get(1).copied();
        let end = match symbol {
            Symbol::Rod | Symbol::Block { .. } | Symbol::Slot { .. } => Some(match second {
                Some((body, point)) => Place::Of {
                    b: index(body),
                    p: flat(point).map(Rounded),
                },
                None => place(&|site, _| site.end),
            }),
            _ => None,
        };
        DrawnSite {
            symbol: symbol.name(),
            place: place(&|site, _| site.place),
            axis: symbol.axis().map(|_| self.heading(id, probes, &carriers)),
            end,
            grounded: probes.first().is_some_and(|p| p.sites[id.0].grounded),
            bodies: group.bodies.iter().map(|&b| index(b)).collect(),
            wheels: probes.first().map_or_else(Vec::new, |p| {
                let wheels = p.sites[id.0].pitch.iter().flatten();
                wheels.map(|w| (index(w.body), Rounded(w.radius))).collect()
            }),
        }
    }

    fn place(
        &self,
        id: ConstraintId,
        probes: &[Probe],
        carriers: &[BodyRef],
        size: f64,
        of: &dyn Fn(&Site, &Scratch) -> [f64; 2],
    ) -> Place {
        for &body in carriers {
            let mut seen = probes
                .iter()
                .map(|p| local(body, of(&p.sites[id.0], &p.scratch), &p.scratch));
            let Some(first) = seen.next() else { break };
            if seen.all(|p| (p[0] - first[0]).hypot(p[1] - first[1]) <= FIXED * size) {
                return Place::Of {
                    b: index(body),
                    p: first.map(Rounded),
                };
            }
        }
        let all = self.every(id, |site, s| of(site, s));
        Place::Free {
            x: Channel::new(all.iter().map(|p| p[0])),
            y: Channel::new(all.iter().map(|p| p[1])),
        }
    }

    fn heading(&self, id: ConstraintId, probes: &[Probe], carriers: &[BodyRef]) -> Heading {
        let angle = |site: &Site| {
            let [x, y] = site.symbol.axis().unwrap_or([1.0, 0.0]);
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
                    a: Rounded(first),
                };
            }
        }
        let mut last: f64 = 0.0;
        let all = self.every(id, |site, _| angle(site));
        // An axis has no orientation, so each angle is the one nearest to the angle before.
        let unwound = all.into_iter().map(|a| {
            last = a + std::f64::consts::PI * ((last - a) / std::f64::consts::PI).round();
            last
        });
        let unwound: Vec<f64> = unwound.collect();
        Heading::Free {
            a: Channel::new(unwound.into_iter()),
        }
    }

    /// A property of a joint in all frames.
    fn every<T>(&self, id: ConstraintId, of: impl Fn(&Site, &Scratch) -> T) -> Vec<T> {
        let frames = self.frames.iter();
        frames
            .map(|frame| {
                let s = self.posed(frame);
                of(&site(self.mechanism, id, &s), &s)
            })
            .collect()
    }
}

/// The joints at a frame.
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
            let held =
                points.map(|(body, [x, y, _])| Some((place(body)?, Rounded(*x), Rounded(*y))));
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
        let markers = mechanism.frames().observed().markers.iter();
        let all = markers.filter_map(|marker| {
            Some(Self {
                name: marker.name.clone(),
                b: drawn(bodies, marker.body)?,
                p: flat(marker.from_centre(mechanism.bodies())).map(Rounded),
                a: Rounded(marker.angle.unwrap_or_default()),
            })
        });
        all.collect()
    }
}

/// Index of a body among those that are drawn.
fn drawn(bodies: &[usize], body: BodyRef) -> Option<isize> {
    match body {
        BodyRef::Ground => Some(GROUND),
        BodyRef::Body(k) => bodies.binary_search(&k).ok().map(|k| k as isize),
    }
}

fn index(body: BodyRef) -> isize {
    body.moving().map_or(GROUND, |k| k as isize)
}

/// A global point in the frame of a body.
fn local(body: BodyRef, [x, y]: [f64; 2], s: &Scratch) -> [f64; 2] {
    let Some(k) = body.moving() else {
        return [x, y];
    };
    flat(s.bodies.to_local(k, [x, y, 0.0]))
}

fn turn(body: BodyRef, s: &Scratch) -> f64 {
    body.moving().map_or(0.0, |k| s.bodies.angle(k))
}
