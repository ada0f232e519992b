//! Axes of the scene, the order of joints, and the points about which moments give way.

use model::{ConstraintId, System};
use pfaff::solvability::{Choice, Compliance, Elasticity};

use super::{of, study};

/// Bounds belong to the mechanism: not to the axes of the scene, nor to the order of joints.
#[test]
fn bounds_do_not_depend_on_the_axes_of_the_scene() {
    let lid = |angle: f64, order: [usize; 4]| {
        let (c, s) = (angle.cos(), angle.sin());
        let at = |x: f64, y: f64| format!("[{:?}, {:?}]", c * x - s * y, s * x + c * y);
        let places = [[0.0, 0.0], [1.0, 0.3], [0.4, 1.0], [-0.7, 0.2]];
        let joints: Vec<String> = order
            .iter()
            .map(|&k| {
                let at = at(places[k][0], places[k][1]);
                format!("{{ name = \"j{k}\", type = \"revolute\", bodies = [\"lid\", \"ground\"], at = {at} }},")
            })
            .collect();
        format!(
            "scene = {{ name = \"lid\", space = \"plane\", gravity = {} }}\n\
             body = [{{ name = \"lid\", mass = 2.0, inertia = 1.0, position = {} }}]\njoint = [\n{}\n]",
            at(3.0, -9.81),
            at(0.3, 0.4),
            joints.join("\n")
        )
    };
    let magnitudes = |angle: f64, order: [usize; 4]| -> Vec<f64> {
        let study = study(&lid(angle, order));
        let start = study.analyse(0.0, None).expect("small");
        let solution = start.solution().expect("decided");
        let found = start.bounds(solution, &Elasticity::default());
        let of = |k: usize| {
            let (id, _) = (order.iter().position(|j| *j == k).expect("listed"), ());
            found.largest_magnitudes(ConstraintId(id)).expect("bounds")[0].expect("a force")
        };
        (0..4).map(of).collect()
    };
    let first = magnitudes(0.0, [0, 1, 2, 3]);
    for (angle, order) in [
        (0.7, [0, 1, 2, 3]),
        (-2.1, [3, 1, 0, 2]),
        (0.0, [2, 3, 1, 0]),
    ] {
        let turned = magnitudes(angle, order);
        for (a, b) in first.iter().zip(&turned) {
            assert!((a - b).abs() < 1e-8 * a, "{first:?} {turned:?}");
        }
    }
}

/// A body on a slide and a clamp. The place of a slide along its own axis has no meaning, but its
/// moment depends on it. With a centre of stiffness the bounds and the loads for elastic supports
/// are those of the mechanism. The names of the bodies in a joint may be swapped.
#[test]
fn a_centre_of_stiffness_decides_where_a_moment_gives_way() {
    let scene = |at: [f64; 3], swapped: bool, centre: &str, turned: bool| {
        // The whole scene may be turned by a quarter about z.
        let t = |[x, y, z]: [f64; 3]| if turned { [-y, x, z] } else { [x, y, z] };
        let order = if swapped {
            "\"ground\", \"top\""
        } else {
            "\"top\", \"ground\""
        };
        let (axis, clamp) = (t([1.0, 0.0, 0.0]), t([0.5, 1.0, 0.0]));
        let (at, load) = (t(at), t([0.2, 0.3, 0.1]));
        format!(
            "scene = {{ name = \"slide\", space = \"spatial\", gravity = {:?} }}\n\
             body = [{{ name = \"top\", mass = 10.0, inertia = [1.0, 1.0, 1.0], position = {load:?} }}]\n\
             joint = [\n\
             {{ name = \"slide\", type = \"translational\", bodies = [{order}], at = {at:?}, axis = {axis:?}{centre} }},\n\
             {{ name = \"clamp\", type = \"fixed\", bodies = [{order}], at = {clamp:?} }},\n]",
            t([1.0, 2.0, -9.81])
        )
    };
    let found = |text: &str| -> Vec<[f64; 2]> {
        let study = study(text);
        let start = study.analyse(0.0, None).expect("small");
        let solution = start.solution().expect("decided");
        let bounds = start.bounds(solution, &Elasticity::default());
        let components = ["Fx", "Fy", "Fz"];
        let mut all: Vec<[f64; 2]> = components
            .map(|name| {
                let own = of(&bounds, 1, name);
                [own.lowest, own.highest]
            })
            .into();
        let soft = start
            .mechanism
            .layout()
            .constraint_ids()
            .map(|reaction| Compliance {
                reaction,
                along: [1e-6; 3],
                rotation: 2e-6,
            });
        let choice = Choice::Compliance(soft.collect::<Vec<_>>().into());
        let chosen = start.distribution(&choice).expect("both give way");
        let clamp = &chosen.reactions[1].components;
        all.extend(components.map(|name| {
            let value = clamp.iter().find(|(known, _)| *known == name);
            [value.expect("a force").1.in_solution().expect("a number"); 2]
        }));
        all
    };
    let near = |a: &[[f64; 2]], b: &[[f64; 2]]| {
        let size = a.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
    };
    let centre = ", centre_of_stiffness = [0.25, 0.0, 0.0]";
    let place = found(&scene([0.0, 0.0, 0.0], false, "", false));
    let moved = found(&scene([1.0, 0.0, 0.0], false, "", false));
    assert!(
        near(&place, &moved) > 1e-3,
        "the place matters: {place:?} {moved:?}"
    );
    let first = found(&scene([0.0, 0.0, 0.0], false, centre, false));
    let again = found(&scene([1.0, 0.0, 0.0], false, centre, false));
    assert!(near(&first, &again) < 1e-8, "{first:?} {again:?}");
    // The same point as the place.
    let same = found(&scene([0.25, 0.0, 0.0], false, "", false));
    assert!(near(&first, &same) < 1e-8, "{first:?} {same:?}");
    // With swapped bodies the reactions have the other sign.
    let swapped = found(&scene([1.0, 0.0, 0.0], true, centre, false));
    let negated: Vec<[f64; 2]> = swapped.iter().map(|[a, b]| [-b, -a]).collect();
    assert!(near(&first, &negated) < 1e-8, "{first:?} {swapped:?}");
    let turned = found(&scene(
        [1.0, 0.0, 0.0],
        false,
        ", centre_of_stiffness = [0.0, 0.25, 0.0]",
        true,
    ));
    let back = [1, 0, 2, 4, 3, 5].map(|k| turned[k]);
    let sign = |k: usize, [a, b]: [f64; 2]| if k % 3 == 1 { [-b, -a] } else { [a, b] };
    let back: Vec<[f64; 2]> = (0..6).map(|k| sign(k, back[k])).collect();
    assert!(near(&first, &back) < 1e-8, "{first:?} {back:?}");
}
