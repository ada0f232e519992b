//! Computes paths from the configurations of a run.

use model::{ConstraintId, Mechanism, Scratch, System};

use super::Path;
use crate::figures::FigureError;
use crate::figures::geometry::posed;
use crate::figures::style::Style;

/// Collects the paths of the centres of selected bodies and of all points with a nonholonomic
/// constraint, such as wheels.
///
/// ```
/// use model::{Body, BodyRef, Description, Joint, Mechanism};
/// use joints::{Direction, KnifeEdge};
/// use pfaff_report::figures::{PathRecorder, paths};
/// let sledge = Description {
///     bodies: vec![Body { name: "sledge".into(), mass: 1.0, inertia: 1.0, ..Body::default() }],
///     joints: vec![Joint::new(
///         "blade",
///         &[BodyRef::Body(0)],
///         KnifeEdge { s: [0.5, 0.0], normal: Direction::Y },
///     )],
///     ..Description::default()
/// };
/// let mechanism = Mechanism::build(&sledge).unwrap();
/// let mut recorder = PathRecorder::new(&mechanism, &[0]).unwrap();
/// recorder.record(0.0, &[0.0, 0.0, 0.0]).unwrap();
/// recorder.record(1.0, &[1.0, 0.0, 0.0]).unwrap();
/// let [centre, blade] = recorder.finish().try_into().unwrap();
/// assert_eq!((centre.x, blade.x), (vec![0.0, 1.0], vec![0.5, 1.5]));
/// ```
pub struct PathRecorder<'m> {
    mechanism: &'m Mechanism,
    scratch: Scratch,
    points: Vec<Point>,
    paths: Vec<Path>,
}

/// A point of the mechanism.
enum Point {
    Centre(usize),
    Place(ConstraintId),
}

impl<'m> PathRecorder<'m> {
    /// An empty recorder; `bodies` contains indices from 0.
    ///
    /// # Errors
    /// - [`FigureError::Body`]: there is no such body.
    pub fn new(mechanism: &'m Mechanism, bodies: &[usize]) -> Result<Self, FigureError> {
        let all = mechanism.bodies();
        if let Some(&index) = bodies.iter().find(|&&k| k >= all.len()) {
            return Err(FigureError::Body {
                mechanism: mechanism.name().to_owned(),
                index,
                bodies: all.len(),
            });
        }
        let groups = &mechanism.layout().groups;
        let touches = |id: &ConstraintId| groups[id.0].spec.nonholonomic() > 0;
        let centres = bodies
            .iter()
            .map(|&k| (Point::Centre(k), all[k].name.clone()));
        let contacts = mechanism
            .layout()
            .constraint_ids()
            .filter(touches)
            .map(|id| (Point::Place(id), groups[id.0].name.clone()));
        let (points, names): (Vec<_>, Vec<_>) = centres.chain(contacts).unzip();
        let paths = names.into_iter().enumerate().map(|(k, label)| Path {
            label,
            x: Vec::new(),
            y: Vec::new(),
            style: Style::nth(k),
        });
        Ok(Self {
            mechanism,
            scratch: mechanism.scratch(),
            points,
            paths: paths.collect(),
        })
    }

    /// Records the configuration q at time t.
    ///
    /// # Errors
    /// - [`FigureError::Coordinates`], [`FigureError::Coordinate`]: q is not a configuration of the
    ///   mechanism.
    pub fn record(&mut self, t: f64, q: &[f64]) -> Result<(), FigureError> {
        let s = &mut self.scratch;
        posed(self.mechanism, t, q, s)?;
        for (point, path) in self.points.iter().zip(&mut self.paths) {
            let [x, y, _] = match *point {
                Point::Centre(k) => s.bodies.origin(k),
                Point::Place(id) => self.mechanism.reactions(s).place(id),
            };
            path.x.push(x);
            path.y.push(y);
        }
        Ok(())
    }

    /// The paths: bodies first, then contact points in the order of their rows.
    #[must_use]
    pub fn finish(self) -> Vec<Path> {
        self.paths
    }
}
