//! Paths of points in the plane: both axes have one scale.

use joints::spec::Level;
use model::{ConstraintId, Mechanism, Scratch, System};

use super::FigureError;
use super::axis::{Axis, drawable, range};
use super::geometry::posed;
use super::plot::{Frame, Labels, legend, legend_height};
use super::style::{INK, Style, TEXT_SIZE, TITLE_SIZE};
use super::svg::{Svg, text_width};

/// The path of a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Its name in the legend.
    pub label: String,
    /// x (m); what is not finite is a gap.
    pub x: Vec<f64>,
    /// y (m).
    pub y: Vec<f64>,
    /// How it looks.
    pub style: Style,
}

impl Path {
    fn points(&self) -> impl DoubleEndedIterator<Item = [f64; 2]> {
        let pairs = self.x.iter().zip(&self.y).map(|(x, y)| [*x, *y]);
        pairs
            .collect::<Vec<_>>()
            .into_iter()
            .filter(|p| p.iter().all(|v| drawable(*v)))
    }
}

/// Largest width and height of the frame (px).
const LARGEST: [f64; 2] = [840.0, 560.0];
/// A frame is at most this many times longer than high, or the reverse.
const SLENDER: f64 = 3.5;
/// Margin of the page (px).
const MARGIN: f64 = 16.0;

/// Paths in the plane with equal axes. A ring marks the start of each, a dot its end.
#[must_use]
pub fn paths(title: &str, paths: &[Path]) -> String {
    let all = || paths.iter().flat_map(Path::points);
    let x = range(all().map(|p| p[0])).unwrap_or([0.0, 1.0]);
    let y = range(all().map(|p| p[1])).unwrap_or([0.0, 1.0]);
    let (x, y, size) = equal(x, y);
    let labels = y.ticks.iter().map(|t| text_width(&t.label, TEXT_SIZE));
    let left = MARGIN + labels.fold(30.0, f64::max) + 30.0;
    let width = left + size[0] + MARGIN;
    let names: Vec<&str> = paths.iter().map(|p| p.label.as_str()).collect();
    let top = MARGIN + 26.0 + legend_height(&names, size[0]) + 6.0;

    let mut svg = Svg::new(width, top + size[1] + 46.0, title);
    svg.element("text")
        .at([("x", left), ("y", MARGIN + 14.0), ("font-size", TITLE_SIZE)])
        .with("font-weight", "bold")
        .with("fill", INK)
        .text(title);
    let entries: Vec<(&str, Style)> = paths.iter().map(|p| (p.label.as_str(), p.style)).collect();
    legend(&mut svg, [left, MARGIN + 24.0], size[0], &entries);
    let frame = Frame {
        left,
        top,
        width: size[0],
        height: size[1],
        x,
        y,
    };
    frame.draw(&mut svg, Labels::Shown);
    axis_labels(&mut svg, &frame);
    if all().next().is_none() {
        frame.note(&mut svg, "no data");
    }
    for path in paths {
        frame.curve(&mut svg, &path.x, &path.y, path.style);
    }
    for path in paths {
        ends(&mut svg, &frame, path);
    }
    svg.finish()
}

/// Axes of one scale around two ranges, and the size of their frame (px).
fn equal(x: [f64; 2], y: [f64; 2]) -> (Axis, Axis, [f64; 2]) {
    // Halves first: the difference of two drawable values may be twice as large.
    let span = |r: [f64; 2]| r[1] - r[0];
    let largest = span(x).max(span(y));
    let least = largest / SLENDER;
    let fallback = if largest > 0.0 { 0.0 } else { 1.0 };
    let room = |r: [f64; 2]| {
        let half = 0.5 * (1.12 * span(r)).max(least).max(fallback);
        let middle = r[0] + 0.5 * span(r);
        [middle - half, middle + half]
    };
    let (x, y) = (room(x), room(y));
    let scale = (LARGEST[0] / span(x)).min(LARGEST[1] / span(y));
    let size = [(scale * span(x)).max(1.0), (scale * span(y)).max(1.0)];
    let ticks = |pixels: f64| ((pixels / 90.0) as usize).max(2);
    (
        Axis::over(x, ticks(size[0])),
        Axis::over(y, ticks(size[1])),
        size,
    )
}

fn axis_labels(svg: &mut Svg, frame: &Frame) {
    svg.element("text")
        .at([
            ("x", frame.left + 0.5 * frame.width),
            ("y", frame.top + frame.height + 34.0),
            ("font-size", TEXT_SIZE),
        ])
        .with("text-anchor", "middle")
        .with("fill", INK)
        .text(&format!("x ({})", frame.x.unit("m")));
    let (x, y) = (MARGIN + 10.0, frame.top + 0.5 * frame.height);
    svg.element("text")
        .at([("x", x), ("y", y), ("font-size", TEXT_SIZE)])
        .with("text-anchor", "middle")
        .with("fill", INK)
        .with("transform", &format!("rotate(-90 {x:.1} {y:.1})"))
        .text(&format!("y ({})", frame.y.unit("m")));
}

fn ends(svg: &mut Svg, frame: &Frame, path: &Path) {
    let (start, end) = (path.points().next(), path.points().next_back());
    for (point, fill) in [(start, "#ffffff"), (end, path.style.colour())] {
        let Some([x, y]) = point else { continue };
        let [x, y] = frame.place(x, y);
        svg.element("circle")
            .at([("cx", x), ("cy", y), ("r", 3.6)])
            .with("fill", fill)
            .with("stroke", path.style.colour())
            .with("stroke-width", "1.5")
            .empty();
    }
}

/// Collects the paths of chosen bodies' centres and of all points that have a nonholonomic constraint: the wheels.
///
/// ```
/// use model::{Body, BodyRef, Description, Joint, Mechanism};
/// use joints::{Direction, KnifeEdge};
/// use report::figures::{PathRecorder, paths};
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
    /// Nothing recorded yet; `bodies` are counted from 0.
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
        let touches = |id: &ConstraintId| groups[id.0].spec.level == Level::Nonholonomic;
        let centres = bodies
            .iter()
            .map(|&k| (Point::Centre(k), all[k].name.clone()));
        let contacts = mechanism
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

    /// Takes the configuration q at time t.
    ///
    /// # Errors
    /// - [`FigureError::Coordinates`], [`FigureError::Coordinate`]: q is no configuration of the mechanism.
    pub fn record(&mut self, t: f64, q: &[f64]) -> Result<(), FigureError> {
        let s = &mut self.scratch;
        posed(self.mechanism, t, q, s)?;
        for (point, path) in self.points.iter().zip(&mut self.paths) {
            let [x, y] = match *point {
                Point::Centre(k) => [s.poses[k].x, s.poses[k].y],
                Point::Place(id) => self.mechanism.place(id, s),
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
