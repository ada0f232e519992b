//! Weaker joints, and the search for replacements, compared with all sets of small problems.

use joints::{ConstraintKernels, Direction, PinInSlot, Revolute, Translational};
use model::{Body, BodyRef, ConstraintId, Description, Mechanism};

use super::Replacements;
use super::search::{Candidate, cheapest};
use crate::groups::Configuration;

/// A block on the ground with one joint.
fn block(joint: impl ConstraintKernels + 'static) -> Mechanism {
    let mut d = Description::new("block");
    let block = d.body(Body::new("block", 1.0, 1.0));
    d.joint("joint", &[BodyRef::Ground, block], joint);
    Mechanism::build(&d).expect("a mechanism")
}

#[test]
fn a_weaker_joint_restricts_no_other_motion() {
    let place = [0.3, 0.2];
    let slider = block(Translational::new(place, place, Direction::X));
    let q = [0.0; 3];
    let configuration = Configuration::decided(&slider, (0.0, &q), None).expect("a rank");
    let search = Replacements::new(&configuration, &q);
    let count = |changed: &Mechanism| search.weaker_joints(changed, &[ConstraintId(0)]).len();
    let slot = |angle: f64| {
        block(PinInSlot {
            s_i: place,
            s_j: place,
            axis: Direction::new([angle.cos(), angle.sin()]).expect("a direction"),
        })
    };
    // The slot has to be parallel to the slider, but the rounding of its direction does not matter.
    let counts = [0.0, 1e-13, 1e-6, 1.0].map(|angle| count(&slot(angle)));
    assert_eq!(counts, [1, 1, 0, 0]);
    // A hinge has the same number of rows, and the slider itself is not weaker.
    let hinge = block(Revolute {
        s_i: place,
        s_j: place,
    });
    assert_eq!([count(&hinge), count(&slider)], [0, 0]);
}

fn candidate(index: usize, cost: usize, forms: &[&[f64]]) -> Candidate {
    Candidate {
        index,
        forms: forms.iter().map(|form| form.to_vec()).collect(),
        cost,
    }
}

#[test]
fn dependent_releases_are_no_replacement() {
    let with = |small: f64| {
        let first = vec![candidate(0, 1, &[&[1.0, 0.0]])];
        let second = vec![candidate(1, 1, &[&[1.0, small]])];
        cheapest(vec![first, second], 2, None)
    };
    assert_eq!(with(1e-3), [[0, 1]]);
    assert!(with(1e-7).is_empty());
    // A component that no free multiplier changes cannot be released.
    let zero = vec![candidate(0, 1, &[&[1e-17]])];
    assert!(cheapest(vec![zero], 1, None).is_empty());
}

#[test]
fn equal_sets_keep_their_order() {
    let with = |first: f64| {
        let forms = [[first, 0.0], [0.5, 0.0]];
        let forms = forms.iter().enumerate();
        let joint = forms.map(|(k, form)| candidate(k, 1, &[form]));
        let other = vec![candidate(2, 1, &[&[0.0, 1.0]])];
        cheapest(vec![joint.collect(), other], 2, None)
    };
    assert_eq!(with(0.5 - 1e-9), [[0, 2], [1, 2]]);
    assert_eq!(with(0.5 - 1e-4), [[1, 2], [0, 2]]);
}

/// Returns a fixed sequence of numbers between −1 and 1.
fn numbers() -> impl FnMut() -> f64 {
    let mut x = 0.37_f64;
    move || {
        x = (x * 97.31 + 0.519).fract();
        2.0 * x - 1.0
    }
}

/// Generic forms are independent. Therefore a set is sufficient iff the number of released
/// components is the number of free components. The cheapest set follows from the numbers of
/// components and the costs alone.
#[test]
fn the_first_set_is_the_cheapest() {
    let mut next = numbers();
    for free in 2..=5 {
        let joints: Vec<Vec<Candidate>> = (0..4)
            .map(|joint| {
                let own = (1..=3).map(|released| {
                    let form = |_| (0..free).map(|_| next()).collect();
                    let forms: Vec<Vec<f64>> = (0..released).map(form).collect();
                    let forms: Vec<&[f64]> = forms.iter().map(Vec::as_slice).collect();
                    let cost = (10.0 * next().abs()) as usize + 1;
                    candidate(3 * joint + released - 1, cost, &forms)
                });
                own.collect()
            })
            .collect();
        // Each digit to the base 4 is the number of components of one joint.
        let costs = (0..256_usize).filter_map(|set| {
            let released = [set % 4, set / 4 % 4, set / 16 % 4, set / 64];
            let costs = released.iter().zip(&joints);
            let costs = costs
                .filter(|(n, _)| **n > 0)
                .map(|(n, own)| own[n - 1].cost);
            (released.iter().sum::<usize>() == free).then(|| costs.sum::<usize>())
        });
        let least = costs.min().expect("a set");
        let found = cheapest(joints.clone(), free, None);
        let all: Vec<&Candidate> = joints.iter().flatten().collect();
        let cost = |way: &Vec<usize>| way.iter().map(|&k| all[k].cost).sum::<usize>();
        assert_eq!(found.first().map(cost), Some(least), "{free}");
        assert!(found.is_sorted_by_key(cost), "{found:?}");
        // A limit removes only the sets that are not cheaper.
        for limit in [least, least + 1, least + 3] {
            let below = cheapest(joints.clone(), free, Some(limit));
            let cheaper = found.iter().filter(|way| cost(way) < limit);
            assert_eq!(
                below,
                cheaper.cloned().collect::<Vec<_>>(),
                "{free}, {limit}"
            );
        }
    }
}

/// No set of these forms releases all components, because the last one is always zero. Without a
/// limit, the search would compare 2⁴⁰ sets.
#[test]
fn the_search_ends() {
    let mut next = numbers();
    let joints = (0..40).map(|joint| {
        let mut form: Vec<f64> = (0..20).map(|_| next()).collect();
        form[19] = 0.0;
        vec![candidate(joint, 1, &[&form])]
    });
    assert!(cheapest(joints.collect(), 20, None).is_empty());
}
