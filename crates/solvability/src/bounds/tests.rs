//! The hull of small systems, compared with manually calculated values.

use super::hull::{Element, Hull, HullError, Range};

fn element(group: usize, row: &[f64], value: f64) -> Element {
    Element {
        group,
        row: row.to_vec(),
        value,
    }
}

/// A fixed sequence of numbers between −1 and 1.
fn numbers() -> impl FnMut() -> f64 {
    let mut x = 0.37_f64;
    move || {
        x = (x * 97.31 + 0.519).fract();
        2.0 * x - 1.0
    }
}

fn hull(elements: Vec<Element>, p: usize) -> Hull {
    Hull::new(elements, p, 0.0).unwrap_or_else(|e| panic!("{e:?}"))
}

#[test]
fn a_weak_component_is_undecided() {
    let with = |weak: f64, tolerance: f64| {
        let elements = vec![
            element(0, &[1.0, 0.0], 1.0),
            element(0, &[0.0, weak], 0.5),
            element(1, &[0.0, 1.0], 2.0),
        ];
        Hull::new(elements, 2, tolerance).map(|hull| hull.sets)
    };
    // The first component is independent of the other components.
    assert_eq!(with(1e-12, 0.0), Ok(1 + 1));
    assert_eq!(with(1e-8, 0.0), Err(HullError::Unclear { group: 0 }));
    assert_eq!(with(1e-3, 0.0), Ok(1 + 2));
    // With data of this accuracy the component may be zero.
    assert_eq!(with(1e-3, 1e-2), Ok(1 + 1));
    assert_eq!(with(1e-3, 5e-4), Err(HullError::Unclear { group: 0 }));
    // The second coordinate changes no element.
    let one = hull(vec![element(0, &[1.0, 0.0], 1.0)], 2);
    let free = one.ends(&[1.0, 0.5]).err();
    assert_eq!(free, Some(HullError::Free { free: 1 }));
    let ends = one.ends(&[2.0, 0.0]).expect("determined");
    assert!(ends.iter().all(|end| (end.value + 2.0).abs() < 1e-12));
}

/// Two loads with two components each. Their monomials are the two squares and the product, and the
/// product lies between the squares. If an end belongs to the product, no compliances give this
/// end.
#[test]
fn the_middle_of_two_joints_is_not_reached() {
    let mut next = numbers();
    let (mut middles, mut squares) = (0, 0);
    for _ in 0..100 {
        let elements = (0..4).map(|k| element(k / 2, &[next(), next()], next()));
        let hull = hull(elements.collect(), 2);
        for end in hull.ends(&[next(), next()]).expect("determined") {
            match end.groups.as_slice() {
                [0, 1] => {
                    middles += 1;
                    assert!(!end.is_reached);
                }
                [_] => {
                    squares += 1;
                    assert!(end.is_reached);
                }
                other => panic!("{other:?}"),
            }
        }
    }
    assert!(middles > 10 && squares > 100, "{middles} {squares}");
}

/// Loads A, B and C of two components each: (1 + x, y − 3), (−2x − 2y − 3, 2x + 1) and (x + 2, y −
/// 1). The smallest x is −2. It is found if all of C is zero, and in the mean of the sets of one
/// component of A and one component of B. Only C gives this value, because A alone gives −1 and B
/// alone −1/2.
#[test]
fn the_soft_loads_of_an_end_are_those_that_reach_it() {
    let elements = vec![
        element(0, &[1.0, 0.0], 1.0),
        element(0, &[0.0, 1.0], -3.0),
        element(1, &[-2.0, -2.0], -3.0),
        element(1, &[2.0, 0.0], 1.0),
        element(2, &[1.0, 0.0], 2.0),
        element(2, &[0.0, 1.0], -1.0),
    ];
    let [lowest, _] = hull(elements, 2).ends(&[1.0, 0.0]).expect("determined");
    assert!((lowest.value + 2.0).abs() < 1e-12 && lowest.is_reached);
    assert_eq!(lowest.groups, [2]);
}

/// A system with one free component and loads with two components. Load X is (a + z·y), which is
/// shortest at y = −(z·a)/|z|². The largest magnitude is found if these values are tried.
#[test]
fn the_magnitude_is_that_of_a_vertex() {
    let mut next = numbers();
    for _ in 0..50 {
        let loads: Vec<[[f64; 2]; 2]> = (0..3)
            .map(|_| [[next(), next()], [next(), next()]])
            .collect();
        let elements = loads
            .iter()
            .enumerate()
            .flat_map(|(group, [a, z])| (0..2).map(move |k| element(group, &[z[k]], a[k])));
        let hull = hull(elements.collect(), 1);
        let at = |[a, z]: &[[f64; 2]; 2]| -(z[0] * a[0] + z[1] * a[1]) / z[0].hypot(z[1]).powi(2);
        let [a, z] = loads[0];
        let norm = |y: f64| (a[0] + z[0] * y).hypot(a[1] + z[1] * y);
        let expected = loads.iter().map(at).map(norm).fold(0.0, f64::max);
        let found = hull.largest_norm(&[(a[0], vec![z[0]]), (a[1], vec![z[1]])]);
        let found = found.expect("bounds");
        assert!(
            (found - expected).abs() < 1e-12 * (1.0 + expected),
            "{found} {expected}"
        );
    }
}

/// With 30 loads and 14 free components there are 145 million sets.
#[test]
fn a_range_that_is_reached_is_not_called_bounds() {
    let mut next = numbers();
    for _ in 0..20 {
        let elements = (0..10).map(|k| {
            let row: Vec<f64> = (0..3).map(|_| next()).collect();
            element(k / 2, &row, next())
        });
        let elements: Vec<Element> = elements.collect();
        let all = hull(elements.clone(), 3);
        let sampled = Hull::of_sets(elements, 3, 0.0, 0).expect("few elements");
        assert!(sampled.is_sampled() && !all.is_sampled() && sampled.sets == 0);
        let along: Vec<f64> = (0..3).map(|_| next()).collect();
        let [all, some] = [&all, &sampled].map(|hull| hull.ends(&along).expect("determined"));
        assert!(all.iter().all(|end| end.is_bound) && some.iter().all(|end| !end.is_bound));
        let width = all[1].value - all[0].value;
        // Each point is a solution, so the range is not wider.
        assert!(some[0].value >= all[0].value - 1e-9 * width);
        assert!(some[1].value <= all[1].value + 1e-9 * width);
        assert!(some[1].value - some[0].value > 0.3 * width);
        let most = sampled.largest_norm(&[(1.0, along)]);
        assert_eq!(most, Err(HullError::Many));
    }
}

/// Many sets of many loads are not examined. A part that is too large for samples is rejected.
#[test]
fn too_many_sets_are_refused() {
    let mut next = numbers();
    let mut of = |n: usize, p: usize| {
        let elements = (0..n).map(|k| {
            let row: Vec<f64> = (0..p).map(|_| next()).collect();
            element(k, &row, next())
        });
        Hull::new(elements.collect(), p, 0.0)
    };
    assert!(of(30, 14).expect("sampled").is_sampled());
    assert_eq!(of(400, 150).err(), Some(HullError::Many));
}

/// Two loads along x and y: (1 + x, 1 + y) and (x, y). For any compliances, x = y, because both
/// components of a load have one compliance. In separate blocks, x − y would be between −1 and 1.
#[test]
fn a_common_load_couples_its_components() {
    let elements = vec![
        element(0, &[1.0, 0.0], 1.0),
        element(0, &[0.0, 1.0], 1.0),
        element(1, &[1.0, 0.0], 0.0),
        element(1, &[0.0, 1.0], 0.0),
    ];
    let hull = hull(elements, 2);
    let [lowest, highest] = hull.ends(&[1.0, -1.0]).expect("determined");
    assert!(lowest.value.abs() < 1e-12 && highest.value.abs() < 1e-12);
    let [lowest, highest] = hull.ends(&[1.0, 0.0]).expect("determined");
    assert!((lowest.value + 1.0).abs() < 1e-12 && highest.value.abs() < 1e-12);
    assert!(lowest.is_reached && highest.is_reached);
    let longest = hull.largest_norm(&[(1.0, vec![1.0, 0.0]), (1.0, vec![0.0, 1.0])]);
    let longest = longest.expect("bounds");
    assert!((longest - 2.0_f64.sqrt()).abs() < 1e-12);
}

/// Two loads of one component each in every coordinate: y_k = −a·c/(a + b) with any ratio a : b.
/// Very large factors do not overflow, and very small compliances do not vanish.
#[test]
fn large_factors_restrict_nothing() {
    for p in [1, 3, 40] {
        for (factor, nominal) in [(1e9, 1e-9), (1e70, 1.0), (1e300, 1e-300), (1e200, 1e250)] {
            let elements = (0..2 * p).map(|k| {
                let mut row = vec![0.0; p];
                row[k / 2] = 1.0;
                element(k, &row, f64::from(u8::from(k % 2 == 0)))
            });
            let mut hull = hull(elements.collect(), p);
            hull.restrict(&Range {
                factor,
                nominal: &vec![nominal; 2 * p],
            });
            let ends = hull.ends(&vec![1.0; p]).expect("determined");
            let p = p as f64;
            let expected = [-p * factor / (1.0 + factor), -p / (1.0 + factor)];
            for (end, expected) in ends.iter().zip(expected) {
                assert!(
                    (end.value - expected).abs() < 1e-9 * p,
                    "{} {expected}",
                    end.value
                );
            }
        }
    }
}
