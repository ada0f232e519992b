//! Tests pictures and tables of mechanisms in space.

use joints::space3::{Axes, Revolute};
use model::words::SceneUnits;
use model::{
    BodyRef, Marker, Measure, MeasureKind, Mechanism, Reaction, SpaceKind, SpatialBody,
    SpatialDescription,
};
use pfaff_report::figures::{Marking, mechanism};
use pfaff_report::{
    MoreColumns, ReactionTable, Selection, Trajectory, TrajectoryTable, columns_of_reactions,
};
use solvability::ChosenValues;

/// A four-bar in a vertical plane that is rotated by `turn` about the vertical axis y.
fn four_bar(turn: f64) -> SpatialDescription {
    let mut d = SpatialDescription {
        gravity: [0.0, -9.81, 0.0],
        ..SpatialDescription::new("four-bar")
    };
    let (sin, cos) = turn.sin_cos();
    let turned = |[x, y]: [f64; 2]| [cos * x, y, -sin * x];
    let inertia = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]];
    let centres = [
        ("crank", [0.15, 0.4]),
        ("coupler", [0.9, 0.95]),
        ("rocker", [1.45, 0.55]),
    ];
    let [crank, coupler, rocker] = centres.map(|(name, at)| {
        d.body(SpatialBody {
            position: turned(at),
            ..SpatialBody::new(name, 1.0, inertia)
        })
    });
    let axis = Axes::new([sin, 0.0, cos], None).expect("an axis");
    for (name, bodies, at) in [
        ("A", [BodyRef::Ground, crank], PLACES[0]),
        ("B", [crank, coupler], PLACES[1]),
        ("C", [coupler, rocker], PLACES[2]),
        ("D", [BodyRef::Ground, rocker], PLACES[3]),
    ] {
        let [s_i, s_j] = bodies.map(|body| d.local(body, turned(at)));
        d.joint(
            name,
            &bodies,
            Revolute {
                s_i,
                s_j,
                axis,
                axis_j: axis,
            },
        );
    }
    d
}

const PLACES: [[f64; 2]; 4] = [[0.0, 0.0], [0.3, 0.8], [1.5, 1.1], [1.4, 0.0]];

/// Returns the positions of the symbols of joints on the page (px), in the order of their names.
fn symbols(svg: &str) -> Vec<[f64; 2]> {
    let mut found: Vec<(String, [f64; 2])> = Vec::new();
    for group in svg
        .split("<g class=\"site plain\" transform=\"translate(")
        .skip(1)
    {
        let (at, rest) = group.split_once(')').expect("a place");
        let (x, y) = at.split_once(' ').expect("two numbers");
        let Some((_, title)) = rest.split_once("<title>").filter(|(tag, _)| tag.len() < 40) else {
            continue;
        };
        let number = |text: &str| text.parse().expect("a number");
        found.push((title[..1].to_owned(), [number(x), number(y)]));
    }
    found.sort_by(|(a, _), (b, _)| a.cmp(b));
    found.into_iter().map(|(_, at)| at).collect()
}

/// The view is from 60° right of the front and 30° above, with y upwards and z towards the front.
/// The axes x, y and z are at (√3/2, −1/4), (0, √3/2) and (−1/2, −√3/4).
#[test]
fn a_four_bar_has_its_joints_where_they_are_seen() {
    let root = 0.75_f64.sqrt();
    for turn in [0.0, 0.4, 1.3] {
        let built = Mechanism::build(&four_bar(turn)).expect("builds");
        let q = built.described_state().0;
        let svg = mechanism(&built, 0.0, &q, Marking::Plain).expect("drawn");
        let (sin, cos) = f64::sin_cos(turn);
        let seen = PLACES.map(|[along, y]| {
            let (x, z) = (cos * along, -sin * along);
            [root * x - 0.5 * z, root * y - 0.25 * x - 0.5 * root * z]
        });
        let drawn = symbols(&svg);
        assert_eq!(drawn.len(), 4, "{svg}");
        // The page is the picture multiplied by one scale factor, with y downwards.
        let scale = (drawn[2][0] - drawn[0][0]) / (seen[2][0] - seen[0][0]);
        assert!(scale > 100.0, "{scale}");
        for k in 1..4 {
            let [dx, dy] = [0, 1].map(|c| drawn[k][c] - drawn[0][c]);
            let [x, y] = [0, 1].map(|c| scale * (seen[k][c] - seen[0][c]));
            // Two digits after the point are written.
            assert!(
                (dx - x).abs() < 0.05 && (dy + y).abs() < 0.05,
                "{turn} {k} {drawn:?}"
            );
        }
        // Each hinge has a line along its axis, and the axes of the ground are drawn in the corner.
        assert_eq!(svg.matches("class=\"rail\"").count(), 4);
        for name in ["x", "y", "z"] {
            assert!(svg.contains(&format!(">{name}</text>")), "{name}");
        }
    }
}

/// The crank turns about its axis x at 3 rad/s and is accelerated by 5 rad/s²; the tip is at 2 m.
#[test]
fn a_trajectory_has_accelerations_and_angles_on_request() {
    let mut d = four_bar(0.0);
    d.bodies.truncate(1);
    d.joints.truncate(1);
    let tip = Marker {
        orientation: Some([1.0, 1.0, 0.0, 0.0]),
        ..Marker::new("tip", BodyRef::Body(0), [0.0, 2.0, 0.0])
    };
    d.observed.markers.push(tip);
    for (name, kind) in [("height", MeasureKind::Z), ("speed", MeasureKind::Speed)] {
        d.observed.measures.push(Measure {
            name: name.into(),
            kind,
            between: [None, Some(0)],
        });
    }
    let built = Mechanism::build(&d).expect("builds");
    let more = MoreColumns {
        accelerations: true,
        angles: true,
    };
    let millimetres = SceneUnits {
        length: Some(("mm", 1e-3)),
        angle: Some(("deg", std::f64::consts::PI / 180.0)),
    };
    let trajectory = Trajectory::new(&built, more);
    let mut table =
        TrajectoryTable::new(Vec::new(), trajectory, Some(millimetres)).expect("writes");
    let q = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    let [v, a] = [3.0, 5.0].map(|x| [0.0, 0.0, 0.0, x, 0.0, 0.0]);
    table.row(0.5, (&q, &v), Some(&a)).expect("writes");
    let error = table
        .row(0.5, (&q, &v), Some(&a[..3]))
        .expect_err("too few");
    assert!(error.to_string().contains("3 accelerations"), "{error}");
    let text = String::from_utf8(table.finish().expect("writes")).expect("UTF-8");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().expect("a header").clone();
    let row: Vec<f64> = reader
        .deserialize()
        .next()
        .expect("one row")
        .expect("numbers");
    assert_eq!(
        (header.len(), reader.deserialize::<Vec<f64>>().count()),
        (row.len(), 0)
    );
    let value = |name: &str| {
        let at = header.iter().position(|column| column == name);
        row[at.unwrap_or_else(|| panic!("{name}: {header:?}"))]
    };
    for (name, expected) in [
        ("t (s)", 0.5),
        ("crank.x (mm)", 1000.0),
        ("crank.qw", 1.0),
        ("crank.wx (deg/s)", 3.0_f64.to_degrees()),
        ("crank.roll (deg)", 0.0),
        ("crank.alphax (deg/s²)", 5.0_f64.to_degrees()),
        ("crank.ax (mm/s²)", 0.0),
        // r·α across, and r·ω² toward the axis.
        ("tip.ay (mm/s²)", -2000.0 * 9.0),
        ("tip.az (mm/s²)", 2000.0 * 5.0),
        ("tip.roll (deg)", 90.0),
        ("tip.vz (mm/s)", 6000.0),
        ("height (mm)", 0.0),
        ("height.rate (mm/s)", 6000.0),
        ("height.acceleration (mm/s²)", 10_000.0),
        ("speed (mm/s)", 6000.0),
        ("speed.rate (mm/s²)", 10_000.0),
    ] {
        assert!(
            (value(name) - expected).abs() < 1e-9,
            "{name}: {}",
            value(name)
        );
    }
    assert!(
        !header
            .iter()
            .any(|name| name.starts_with("speed.acceleration"))
    );
}

#[test]
fn tables_have_the_columns_of_space() {
    let mut d = four_bar(0.0);
    d.bodies.truncate(1);
    d.joints.truncate(1);
    let tip = Marker::new("tip", BodyRef::Body(0), [0.0, 2.0, 0.0]);
    d.observed.markers.push(tip);
    let built = Mechanism::build(&d).expect("builds");
    let mut table = TrajectoryTable::new(
        Vec::new(),
        Trajectory::new(&built, MoreColumns::default()),
        None,
    )
    .expect("writes");
    // The rotation is a quarter of a turn about x, with ω = (0, 0, 3) in body axes and (0, −3, 0)
    // in ground axes. The tip is at 2 m along z, and moves along −x.
    let half = 0.5_f64.sqrt();
    let q = [1.0, 2.0, 3.0, half, half, 0.0, 0.0];
    table
        .row(0.5, (&q, &[4.0, 5.0, 6.0, 0.0, 0.0, 3.0]), None)
        .expect("writes");
    let text = String::from_utf8(table.finish().expect("writes")).expect("UTF-8");
    let (header, row) = text.trim_end().split_once('\n').expect("a row");
    assert_eq!(
        header,
        "t,crank.x,crank.y,crank.z,crank.qw,crank.qx,crank.qy,crank.qz,crank.vx,crank.vy,crank.vz,\
         crank.wx,crank.wy,crank.wz,tip.x,tip.y,tip.z,tip.vx,tip.vy,tip.vz"
    );
    let numbers: Vec<f64> = row
        .split(',')
        .map(|x| x.parse().expect("a number"))
        .collect();
    let expected = [
        0.5,
        1.0,
        2.0,
        3.0,
        half,
        half,
        0.0,
        0.0,
        4.0,
        5.0,
        6.0,
        0.0,
        -3.0,
        0.0,
        1.0,
        2.0,
        5.0,
        4.0 - 6.0,
        5.0,
        6.0,
    ];
    assert_eq!(numbers.len(), expected.len());
    for (k, (a, b)) in numbers.iter().zip(expected).enumerate() {
        assert!((a - b).abs() < 1e-14, "{k}: {a} {b}");
    }

    let columns = columns_of_reactions(&built, &Selection::All, &[], |_| false);
    let columns = columns.expect("all of them");
    let mut table =
        ReactionTable::new("choice.csv", Vec::new(), &built, columns, None).expect("writes");
    let reaction = Reaction::new(SpaceKind::Space3, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], None);
    let none = ChosenValues::new(Vec::new(), Vec::new());
    table
        .row(0.0, &ChosenValues::new(vec![reaction], Vec::new()), &none)
        .expect("writes");
    let text = String::from_utf8(table.finish().expect("writes").0).expect("UTF-8");
    assert_eq!(
        text,
        "t,A.Fx,A.Fy,A.Fz,A.Tx,A.Ty,A.Tz\n0.0,1.0,2.0,3.0,4.0,5.0,6.0\n"
    );
}
