//! Tests headers and rows against reference text, exact bits, and the rejection of rows of another
//! mechanism.

use joints::plane::Direction;
use joints::{KnifeEdge, Revolute, RevoluteAngleDrive};
use model::{
    Body, BodyRef, ConstraintId, Description, Drive, Function, Joint, Mechanism, Reaction,
};
use solvability::{ChosenValues, Group, Stretches, Term, Verdict, VerdictStretch, VerdictTrack};

use super::{
    MoreColumns, Quantity, ReactionTable, Selection, TableError, Trajectory, TrajectoryTable,
    columns_of_reactions, write_chosen, write_determined,
};

/// A driven wheel carrier with a knife edge, and names that need quotes.
fn carrier() -> Mechanism {
    let body = |name: &str| Body {
        name: name.into(),
        mass: 1.0,
        inertia: 1.0,
        ..Body::default()
    };
    let pair = [BodyRef::Body(0), BodyRef::Body(1)];
    let at = [0.0, 0.0];
    let drive = RevoluteAngleDrive::new(at, at);
    let blade = KnifeEdge {
        s: at,
        normal: Direction::Y,
    };
    let description = Description {
        bodies: vec![body("base"), body("arm, left")],
        joints: vec![
            Joint::new("pin", &pair, Revolute { s_i: at, s_j: at }),
            Joint::new("blade", &pair[..1], blade),
        ],
        drives: vec![Drive {
            name: "motor".into(),
            bodies: pair.to_vec(),
            element: Box::new(drive),
            motion: Function::steps(0.0, &[]).expect("no step at all"),
            tolerance: None,
        }],
        ..Description::default()
    };
    Mechanism::build(&description).expect("the carrier builds")
}

/// A table of all values of these reactions.
fn table(mechanism: &Mechanism, selection: &Selection) -> ReactionTable<Vec<u8>> {
    let columns = columns_of_reactions(mechanism, selection, &[], |_| false).expect("exist");
    ReactionTable::new("choice.csv", Vec::new(), mechanism, columns, None).expect("writes")
}

/// The written text of a row without groups.
fn written(mut table: ReactionTable<Vec<u8>>, t: f64) -> String {
    let none = ChosenValues::new(Vec::new(), Vec::new());
    let row = ChosenValues::new(reactions().to_vec(), Vec::new());
    table.row(t, &row, &none).expect("writes");
    text(table.finish().expect("writes").0)
}

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).expect("CSV is UTF-8")
}

#[test]
fn trajectory_has_the_header_of_the_contract() {
    let carrier = carrier();
    let mut table = TrajectoryTable::new(
        Vec::new(),
        Trajectory::new(&carrier, MoreColumns::default()),
        None,
    )
    .expect("writes");
    let (q, v) = ([0.0, 1.0, 2.0, 3.0, 4.0, 5.0], [0.5; 6]);
    table.row(0.1, (&q, &v), None).expect("writes");
    let expected = "t,base.x,base.y,base.angle,base.vx,base.vy,base.omega,\
                    \"arm, left.x\",\"arm, left.y\",\"arm, left.angle\",\
                    \"arm, left.vx\",\"arm, left.vy\",\"arm, left.omega\"\n\
                    0.1,0.0,1.0,2.0,0.5,0.5,0.5,3.0,4.0,5.0,0.5,0.5,0.5\n";
    assert_eq!(text(table.finish().expect("writes")), expected);
}

/// Reactions of pin, motor and knife edge, in the order of their rows.
fn reactions() -> [Reaction; 3] {
    let with = |x: f64, component| Reaction {
        force: [x, 0.5, 0.0],
        torque: [0.0, 0.0, -x],
        component,
    };
    [with(1.0, None), with(2.0, Some(7.0)), with(3.0, Some(8.0))]
}

#[test]
fn reactions_have_the_header_of_the_contract() {
    let table = table(&carrier(), &Selection::All);
    let expected = "t,pin.Fx,pin.Fy,pin.T,motor.Fx,motor.Fy,motor.T,motor.drive,\
                    blade.Fx,blade.Fy,blade.T,blade.N\n\
                    0.25,1.0,0.5,-1.0,2.0,0.5,-2.0,7.0,3.0,0.5,-3.0,8.0\n";
    assert_eq!(written(table, 0.25), expected);
}

/// A cell has a value if the component is determined on the interval that contains the time. A row
/// at a boundary belongs to the interval that starts there. A fragile column is marked, and columns
/// of sums follow.
#[test]
fn cells_are_empty_where_nothing_is_determined() {
    let carrier = carrier();
    let blade = ConstraintId(2);
    let term = |component: &str| Term {
        reaction: blade,
        component: component.into(),
        coefficient: 2.0,
    };
    let groups = [("twice".to_owned(), Group::Combination(vec![term("N")]))];
    let only = Selection::Names(vec!["blade".into()]);
    let is_fragile = |quantity: &Quantity| match quantity {
        Quantity::Component(_, name) => *name == "Fy",
        Quantity::Group(k, name) => (*k, *name) == (0, "sum"),
    };
    let columns = columns_of_reactions(&carrier, &only, &groups, is_fragile).expect("exist");
    let mut table =
        ReactionTable::new("choice.csv", Vec::new(), &carrier, columns, None).expect("writes");
    let row = ChosenValues::new(reactions().to_vec(), vec![1]);
    for (t, sum) in [(0.0, 16.0), (1.0, f64::NAN), (2.0, 17.0)] {
        let sum = ChosenValues::new(vec![sum], vec![1]);
        table.row(t, &row, &sum).expect("writes");
    }
    let (all, columns) = table.finish().expect("writes");
    let stretch = |from, to, verdict| VerdictStretch { from, to, verdict };
    let mut stretches = Stretches::unique(&carrier, [0.0, 2.0], &[groups[0].1.clone()]);
    stretches.reactions[2].components[0].1 = VerdictTrack::of([
        stretch(0.0, 1.0, Verdict::NotUnique),
        stretch(1.0, 2.0, Verdict::Unique),
    ]);
    let mut determined = Vec::new();
    let has_empty = write_determined(&all[..], &mut determined, &columns, &stretches);
    assert!(has_empty.expect("writes"));
    let expected = "t,blade.Fx,blade.Fy.fragile,blade.T,blade.N,twice.fragile\n\
                    0.0,,0.5,-3.0,8.0,16.0\n\
                    1.0,3.0,0.5,-3.0,8.0,\n\
                    2.0,3.0,0.5,-3.0,8.0,17.0\n";
    assert_eq!(text(determined), expected);
    // In the table of one solution for the multipliers, the cells that are not determined have the
    // values of this solution. All other cells are unchanged.
    let mut table = ReactionTable::new("choice.csv", Vec::new(), &carrier, columns.clone(), None)
        .expect("writes");
    let row = ChosenValues::new(
        reactions()
            .map(|r| Reaction {
                force: [-4.0; 3],
                ..r
            })
            .to_vec(),
        vec![],
    );
    for t in [0.0, 1.0, 2.0] {
        let sum = ChosenValues::new(vec![5.0], vec![]);
        table.row(t, &row, &sum).expect("writes");
    }
    let (own, columns) = table.finish().expect("writes");
    let mut chosen = Vec::new();
    let written = write_chosen(&all[..], &own[..], &mut chosen, &columns, &stretches);
    written.expect("writes");
    assert_eq!(text(chosen), expected.replacen(",,", ",-4.0,", 1));
}

#[test]
fn selected_reactions_keep_the_order_of_rows() {
    let names = Selection::Names(vec!["blade".into(), "pin".into(), "pin".into()]);
    let table = table(&carrier(), &names);
    let expected = "t,pin.Fx,pin.Fy,pin.T,blade.Fx,blade.Fy,blade.T,blade.N\n\
                    0.0,1.0,0.5,-1.0,3.0,0.5,-3.0,8.0\n";
    assert_eq!(written(table, 0.0), expected);
}

#[test]
fn unknown_names_and_foreign_rows_are_refused() {
    let names = Selection::Names(vec!["pin".into(), "wheel".into()]);
    let Err(error) = columns_of_reactions(&carrier(), &names, &[], |_| false) else {
        panic!("there is no `wheel`");
    };
    assert_eq!(
        error.to_string(),
        "no joint or drive is called `wheel`; there are: pin, motor, blade"
    );
    let carrier = carrier();
    let mut table = TrajectoryTable::new(
        Vec::new(),
        Trajectory::new(&carrier, MoreColumns::default()),
        None,
    )
    .expect("writes");
    let error = table
        .row(2.5, (&[0.0; 3], &[0.0; 6]), None)
        .expect_err("too few");
    assert_eq!(
        error.to_string(),
        "trajectory.csv: 3 coordinates at t = 2.5 s, the mechanism has 6"
    );
    let lines = text(table.finish().expect("writes")).lines().count();
    assert_eq!(lines, 1, "a refused row leaves no trace");
}

#[test]
fn numbers_read_back_to_the_same_bits() {
    let values = [
        0.1,
        -0.0,
        1.0 / 3.0,
        f64::MIN_POSITIVE,
        5e-324,
        f64::MAX,
        1e300,
        -1e-300,
        123_456_789.123_456_79,
        std::f64::consts::PI,
        f64::EPSILON,
        1e22,
    ];
    let carrier = carrier();
    let mut table = TrajectoryTable::new(
        Vec::new(),
        Trajectory::new(&carrier, MoreColumns::default()),
        None,
    )
    .expect("writes");
    table
        .row(9.0, (&values[..6], &values[6..]), None)
        .expect("writes");
    let written = text(table.finish().expect("writes"));
    let mut reader = csv::Reader::from_reader(written.as_bytes());
    let row: Vec<f64> = reader
        .deserialize()
        .next()
        .expect("one row")
        .expect("numbers");
    let [q0, v0, q1, v1] = [0, 6, 3, 9].map(|k| &values[k..k + 3]);
    let expected: Vec<u64> = [&[9.0], q0, v0, q1, v1]
        .concat()
        .iter()
        .map(|x| x.to_bits())
        .collect();
    let found: Vec<u64> = row.iter().map(|x| x.to_bits()).collect();
    assert_eq!(found, expected);
    assert!(written.len() < 600, "extremes are short: {written}");
}

#[test]
fn what_does_not_exist_is_nan() {
    let carrier = carrier();
    let mut table = TrajectoryTable::new(
        Vec::new(),
        Trajectory::new(&carrier, MoreColumns::default()),
        None,
    )
    .expect("writes");
    table
        .row(0.0, (&[f64::NAN; 6], &[0.0; 6]), None)
        .expect("writes");
    let written = text(table.finish().expect("writes"));
    let row = written.lines().nth(1).expect("one row");
    assert!(row.starts_with("0.0,NaN,NaN,NaN,0.0,"), "{row}");
}

/// A writer that fails like a full disk.
struct Full;

impl std::io::Write for Full {
    fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
        Err(std::io::ErrorKind::StorageFull.into())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_an_error_of_the_table() {
    let carrier = carrier();
    let mut table = TrajectoryTable::new(
        Full,
        Trajectory::new(&carrier, MoreColumns::default()),
        None,
    )
    .expect("still in the buffer");
    let mut written = Ok(());
    for k in 0..10_000 {
        written = table.row(f64::from(k), (&[0.1; 6], &[0.1; 6]), None);
        if written.is_err() {
            break;
        }
    }
    let error = written.expect_err("the buffer is smaller than that");
    assert!(matches!(
        &error,
        TableError::Write { source, .. } if source.kind() == std::io::ErrorKind::StorageFull
    ));
    assert!(error.to_string().starts_with("trajectory.csv: "));
    assert!(table.finish().is_err());
}
