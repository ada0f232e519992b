//! Tests only the text of the scenes. The package `tests`, which can read scenes, compares ranks
//! and verdicts on reactions.

use std::collections::BTreeSet;
use std::io::{self, Write};

use super::*;

fn text(order: &Order) -> String {
    let mut out = Vec::new();
    let generator = order.generate().expect("a possible order");
    generator.write(&mut out).expect("memory takes everything");
    String::from_utf8(out).expect("UTF-8")
}

/// Returns texts in the values of a key.
fn texts<'t>(scene: &'t str, key: &'t str) -> impl Iterator<Item = &'t str> {
    let values = scene.lines().filter_map(move |line| {
        let (found, value) = line.split_once(" = ")?;
        (found == key).then_some(value)
    });
    values.flat_map(|value| value.split('"').skip(1).step_by(2))
}

#[test]
fn the_text_has_what_the_answer_says() {
    for &kind in Kind::ALL {
        for n in [1, 2, 3, 10, 33] {
            let order = Order::of(kind, n);
            let (scene, answer) = (text(&order), order.generate().expect("possible").answer());
            let tables = |header: &str| scene.lines().filter(|line| *line == header).count();
            assert_eq!(tables("[[body]]"), answer.bodies, "{kind:?} {n}");
            assert_eq!(tables("[[joint]]"), answer.joints, "{kind:?} {n}");
            assert_eq!(tables("[[drive]]"), answer.drives, "{kind:?} {n}");
            assert_eq!(answer.rows, answer.rank + answer.redundancy);
            let rows = texts(&scene, "type").map(|joint| match joint {
                "revolute" | "translational" => 2,
                "knife-edge" | "displacement" => 1,
                _ => 0,
            });
            assert_eq!(rows.sum::<usize>(), answer.rows, "{kind:?} {n}");
        }
    }
}

#[test]
fn names_occur_once_and_bodies_exist() {
    for &kind in Kind::ALL {
        let order = Order::of(kind, 20);
        let scene = text(&order);
        let list: Vec<&str> = texts(&scene, "name").collect();
        let names: BTreeSet<&str> = list.iter().copied().collect();
        // The format allows a body and a joint with the same name, but in generated scenes all
        // these names differ.
        assert_eq!(list.len(), names.len(), "{kind:?}");
        for body in texts(&scene, "bodies").chain(texts(&scene, "body")) {
            assert!(body == "ground" || names.contains(body), "{kind:?}: {body}");
        }
        for reaction in order.generate().expect("possible").free_reactions() {
            assert!(names.contains(&*reaction.name), "{kind:?}: {reaction:?}");
        }
    }
}

#[test]
fn same_order_same_bytes_and_another_seed_another_scene() {
    for kind in [Kind::Parallelograms, Kind::Random] {
        let with = |seed| Order {
            seed: Some(seed),
            ..Order::of(kind, 30)
        };
        assert_eq!(text(&with(5)), text(&with(5)));
        assert_ne!(text(&with(5)), text(&with(6)));
        assert_eq!(text(&Order::of(kind, 30)), text(&with(1)));
    }
}

#[test]
fn sizes_are_known_beforehand() {
    for &kind in Kind::ALL {
        for n in [1, 100, 5000] {
            let n = if kind == Kind::Lattice { n / 50 + 1 } else { n };
            let order = Order::of(kind, n);
            let expected = order.generate().expect("possible").bytes();
            let ratio = expected / text(&order).len() as f64;
            assert!((0.9..1.1).contains(&ratio), "{kind:?} {n}: {ratio}");
        }
    }
}

#[test]
fn impossible_orders_are_refused_with_their_numbers() {
    let refusal = |order: Order| match order.generate() {
        Ok(generator) => panic!("{generator:?} is possible"),
        Err(error) => error.to_string(),
    };
    assert_eq!(
        refusal(Order::of(Kind::Parallelograms, 0)),
        "parallelograms of n = 0 is empty: n counts cells, need at least 1"
    );
    for n in [1_000_000_000, usize::MAX] {
        for &kind in Kind::ALL {
            let message = refusal(Order::of(kind, n));
            assert!(message.contains("GB, more than 10 GB"), "{message}");
        }
    }
    // A lattice grows with the square of n.
    assert!(Order::of(Kind::Lattice, 100_000).generate().is_err());
    assert!(Order::of(Kind::NFourBar, 100_000).generate().is_ok());
    let with = |redundant| Order {
        redundant: Some(redundant),
        ..Order::of(Kind::Random, 3)
    };
    for share in [-0.1, 1.1, f64::NAN, f64::INFINITY] {
        assert_eq!(
            refusal(with(share)),
            format!("the redundant share is {share}, need a number from 0 to 1")
        );
    }
    let order = Order {
        redundant: Some(0.5),
        ..Order::of(Kind::Fleet, 3)
    };
    assert_eq!(
        refusal(order),
        "fleet takes no redundant share: its redundancy has no choice"
    );
    let order = Order {
        seed: Some(3),
        ..Order::of(Kind::Lattice, 3)
    };
    assert_eq!(
        refusal(order),
        "lattice takes no seed: the campaign contains no random choices"
    );
}

/// A writer that accepts some bytes and then fails.
struct Full(usize);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.0.checked_sub(bytes.len()) {
            Some(left) => {
                self.0 = left;
                Ok(bytes.len())
            }
            None => Err(io::ErrorKind::StorageFull.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn what_the_writer_refuses_is_said() {
    for &kind in Kind::ALL {
        let generator = Order::of(kind, 200).generate().expect("possible");
        for room in [0, 70_000] {
            let refused = generator.write(Full(room)).err();
            let refused = refused.map(|e| e.kind());
            assert_eq!(refused, Some(io::ErrorKind::StorageFull), "{kind:?} {room}");
        }
    }
}
