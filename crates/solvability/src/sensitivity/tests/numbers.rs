//! Numbers of reactions in random mechanisms, compared with mechanisms in which one datum is moved.
//! The configuration follows by Newton's method, the dropped rows do not change, and the loads are
//! constant.

use joints::{
    Direction, Distance, Gear, PinInSlot, PinInSlotDisplacementDrive, RevoluteAngleDrive,
    Translational, TranslationalDisplacementDrive,
};
use linalg::Matrix;
use model::space::{cross, difference};
use model::{DataUnit, Frame};

use super::*;
use crate::groups::{Group, Term};
use crate::sensitivity::instant::units;

/// Steps of the differences, as share of the size or in radians.
const H: f64 = 1e-6;

/// Permitted relative difference between a derivative and its difference quotient.
const AGREEMENT: f64 = 2e-3;

/// Rounding of differences, relative to the load.
const ROUNDING: f64 = 1e-8;

/// Pseudo-random numbers from −1 to 1.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(0x5851_f42d_4c95_7f2d)
            .wrapping_add(0x1405_7b7e_f767_814f);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.next())
    }

    fn below(&mut self, n: usize) -> usize {
        ((0.5 + 0.5 * self.next()) * n as f64) as usize % n
    }
}

/// A planar mechanism: a tree with a few additional joints, and with armatures of its joints in
/// multiples of an inertia.
fn plane(draw: &mut Draw, armatures: f64) -> Mechanism {
    let mut d = Description::new("plane");
    d.gravity = [3.0, -9.0];
    let n = 1 + draw.below(3);
    let bodies: Vec<BodyRef> = (0..n)
        .map(|k| {
            d.body(Body {
                position: draw.vector(),
                angle: 3.0 * draw.next(),
                ..Body::new(&format!("body {k}"), 1.5 + draw.next(), 0.3)
            })
        })
        .collect();
    for k in 0..n + 1 + draw.below(2) {
        let first = if k < n { k.checked_sub(1) } else { None };
        let own = bodies[if k < n { k } else { draw.below(n) }];
        let other = first.map_or(BodyRef::Ground, |k| bodies[k]);
        let pair = if draw.below(2) == 0 {
            [own, other]
        } else {
            [other, own]
        };
        let at: [f64; 2] = draw.vector();
        let [s_i, s_j] = pair.map(|body| d.local(body, at));
        let axis = Direction::new(draw.vector()).expect("a direction");
        let name = &format!("J{k}");
        match draw.below(6) {
            0 => {
                let drive = TranslationalDisplacementDrive::new(s_i, s_j, axis);
                d.armature(name, &pair, drive, armatures * 2.0);
                d.joint(name, &pair, Translational::new(s_i, s_j, axis))
            }
            1 => {
                let drive = PinInSlotDisplacementDrive::new(s_i, s_j, axis);
                d.armature(name, &pair, drive, armatures);
                d.joint(name, &pair, PinInSlot { s_i, s_j, axis })
            }
            2 => d.joint(
                name,
                &[own],
                KnifeEdge {
                    s: s_i,
                    normal: axis,
                },
            ),
            3 => {
                let end = d.local(pair[1], [at[0] + 0.7, at[1] - 0.4]);
                d.joint(name, &pair, Distance::new(s_i, end))
            }
            4 if pair[1] != BodyRef::Ground && pair[0] != BodyRef::Ground => {
                let mesh = [pair[0], pair[1], BodyRef::Ground];
                d.joint(name, &mesh, Gear::new(-0.6))
            }
            _ => {
                let drive = RevoluteAngleDrive::new(s_i, s_j);
                d.armature(name, &pair, drive, armatures * 0.4);
                d.joint(name, &pair, Revolute { s_i, s_j })
            }
        };
    }
    Mechanism::build(&d).expect("it builds")
}

/// A spatial mechanism of the same kind.
fn spatial(draw: &mut Draw) -> Mechanism {
    const KINDS: [Kind; 6] = [
        Kind::Revolute,
        Kind::Cylindrical,
        Kind::Translational,
        Kind::Spherical,
        Kind::Planar,
        Kind::OnPlane,
    ];
    let mut sketch = Sketch::new();
    sketch.d.gravity = [2.0, -3.0, -9.0];
    let n = 1 + draw.below(3);
    let bodies: Vec<BodyRef> = (0..n)
        .map(|k| sketch.body(&format!("body {k}"), draw.vector()))
        .collect();
    for k in 0..n + 1 + draw.below(2) {
        let first = if k < n { k.checked_sub(1) } else { None };
        let own = bodies[if k < n { k } else { draw.below(n) }];
        let other = first.map_or(GROUND, |k| bodies[k]);
        let pair = if draw.below(2) == 0 {
            [own, other]
        } else {
            [other, own]
        };
        let (name, at, w) = (format!("J{k}"), draw.vector(), draw.vector());
        match draw.below(7) {
            6 => sketch.bar(&name, pair, [at, w.map(|x| x + 1.5)]),
            kind => sketch.joint(&name, KINDS[kind], pair, at, w),
        }
    }
    Mechanism::build(&sketch.d).expect("it builds")
}

/// A mechanism at an instant with its rows, its loads and a solution.
struct At {
    q: Vec<f64>,
    v: Vec<f64>,
    s: model::Scratch,
    lambda: Vec<f64>,
    a: Vec<f64>,
}

/// Returns the smallest change x with `rows·x = r`, for velocities in these units.
fn least(rows: &Matrix, units: &[f64], r: &[f64]) -> Vec<f64> {
    let scaled = Matrix::from_fn(rows.nrows(), units.len(), |i, j| rows[(i, j)] * units[j]);
    let normal = scaled.product(&scaled.transpose());
    let y = if r.is_empty() {
        Vec::new()
    } else {
        solved(&normal, r, false)
    };
    let x = scaled.transpose_times(&y);
    x.iter().zip(units).map(|(x, unit)| x * unit).collect()
}

/// The state nearest to q and v on the kept rows, and the reactions under this force.
fn follow(
    mechanism: &Mechanism,
    (q, v): (&[f64], &[f64]),
    kept: &[usize],
    units: &[f64],
    force: Option<&[f64]>,
) -> At {
    let layout = mechanism.layout();
    let (n, m) = (layout.n_v, layout.rows());
    let mut s = mechanism.scratch();
    let mut q = q.to_vec();
    let holonomic: Vec<usize> = kept.iter().copied().filter(|&i| i < layout.m).collect();
    for _ in 0..6 {
        mechanism.pose(0.0, &q, &mut s);
        mechanism.phi(&mut s);
        mechanism.c(&mut s);
        let missed: Vec<f64> = holonomic.iter().map(|&i| s.phi[i]).collect();
        let step = least(&layout.dense(&s).select_rows(&holonomic), units, &missed);
        q = mechanism.space().displaced(&q, -1.0, &step);
    }
    mechanism.pose(0.0, &q, &mut s);
    mechanism.c(&mut s);
    mechanism.b(&mut s);
    let c = layout.dense(&s).select_rows(kept);
    let missed: Vec<f64> = (0..kept.len())
        .map(|i| s.b[kept[i]] - c.row(i).iter().zip(v).map(|(c, v)| c * v).sum::<f64>())
        .collect();
    let step = least(&c, units, &missed);
    let v: Vec<f64> = v.iter().zip(step).map(|(v, step)| v + step).collect();
    mechanism.twist(&v, &mut s);
    mechanism.gamma(&mut s);
    mechanism.force(&mut s);
    let force = force.unwrap_or(&s.force);
    let mut inertia = Matrix::zeros(n, n);
    for j in 0..n {
        let mut unit = vec![0.0; n];
        unit[j] = 1.0;
        inertia
            .row_mut(j)
            .copy_from_slice(&mechanism.inertia(&s).product(&unit));
    }
    let saddle = Matrix::from_fn(n + kept.len(), n + kept.len(), |i, j| {
        match (i < n, j < n) {
            (true, true) => inertia[(i, j)],
            (true, false) => c[(j - n, i)],
            (false, true) => c[(i - n, j)],
            (false, false) => 0.0,
        }
    });
    let gamma = kept.iter().map(|&i| s.gamma[i]);
    let right: Vec<f64> = force.iter().copied().chain(gamma).collect();
    let x = solved(&saddle, &right, false);
    let mut lambda = vec![0.0; m];
    kept.iter().zip(&x[n..]).for_each(|(&i, x)| lambda[i] = *x);
    let a = x[..n].to_vec();
    At { q, v, s, lambda, a }
}

/// A number, a function that computes it, and whether it is a moment.
type Asked = (ReactionNumber, Box<dyn Fn(&Mechanism, &At) -> f64>, bool);

/// All components of all reactions, moments about a point, components in other frames, and sums.
fn asked(mechanism: &Mechanism) -> Vec<Asked> {
    let layout = mechanism.layout();
    let space = layout.space;
    let mut all: Vec<Asked> = Vec::new();
    const ABOUT: [f64; 3] = [0.4, -1.1, 0.0];
    for id in layout.constraint_ids() {
        for k in layout.groups[id.0].components() {
            let name = space.components()[k];
            let number = ReactionNumber::component(mechanism, id, name).expect("a component");
            let value = move |m: &Mechanism, at: &At| {
                let reaction = m.reactions(&at.s).reaction(id, &at.lambda);
                reaction.components(space).nth(k).expect("a component")
            };
            all.push((number, Box::new(value), space.torques().contains(&k)));
        }
        let moment = move |m: &Mechanism, at: &At| {
            let reactions = m.reactions(&at.s);
            let reaction = reactions.reaction(id, &at.lambda);
            let arm = difference(reactions.place(id), ABOUT);
            reaction.torque[2] + cross(arm, reaction.force)[2]
        };
        let number = ReactionNumber::moment(id, [0.0, 0.0, 1.0], ABOUT);
        all.push((number, Box::new(moment), true));
        for frame in [Frame::FirstBody, Frame::Joint, Frame::Edge] {
            let first = move |m: &Mechanism, at: &At| {
                let reactions = m.reactions(&at.s);
                let force = reactions.reaction(id, &at.lambda).force;
                let axes = reactions.axes(id, frame).expect("such a frame");
                axes[0].iter().zip(force).map(|(u, f)| u * f).sum()
            };
            let mut s = mechanism.scratch();
            mechanism.pose(0.0, &mechanism.described_state().0, &mut s);
            if mechanism.reactions(&s).axes(id, frame).is_some() {
                all.push((
                    ReactionNumber::in_frame(id, frame, 0),
                    Box::new(first),
                    false,
                ));
            }
        }
    }
    let (first, last) = (ConstraintId(0), ConstraintId(layout.groups.len() - 1));
    let term = |reaction, component: &str, coefficient| Term {
        reaction,
        component: component.into(),
        coefficient,
    };
    let sum = Group::Combination(vec![term(first, "Fx", 1.0), term(last, "Fy", -0.8)]);
    let sum = ReactionNumber::of_group(mechanism, &sum, None).expect("names");
    let value = move |m: &Mechanism, at: &At| {
        let of = |id| m.reactions(&at.s).reaction(id, &at.lambda).force;
        of(first)[0] - 0.8 * of(last)[1]
    };
    all.push((sum[0].1.clone(), Box::new(value), false));
    all
}

/// The largest change of each number that follows from moving one datum.
fn expected(mechanism: &Mechanism, at: &At, kept: &[usize], all: &[Asked]) -> Vec<f64> {
    let size = model::start::scene_size(mechanism, &at.q);
    let units = units(mechanism, size);
    let numbers = mechanism.data().numbers();
    let mut largest = vec![0.0_f64; all.len()];
    for block in mechanism.data().blocks(&at.s) {
        let reach = mechanism.layout().groups[block.group].bodies.iter();
        let reach = reach.filter_map(|b| b.moving()).map(|k| mechanism.reach(k));
        let piece = crate::limits::PIECE * reach.fold(0.0, f64::max);
        let (moved, h) = match block.unit {
            DataUnit::Length => (MOVED * size.min(piece), H * size),
            DataUnit::Angle => (MOVED, H),
        };
        let mut squares = vec![0.0; all.len()];
        for k in 0..block.directions() {
            let [plus, minus] = [h, -h].map(|h| {
                let mut by = [0.0; 3];
                by[k] = h;
                let mut other = numbers.clone();
                let own = block.displaced(&numbers[block.numbers.clone()], by);
                other[block.numbers.clone()].copy_from_slice(&own);
                let mechanism = mechanism.with_numbers(&other);
                let there = follow(&mechanism, (&at.q, &at.v), kept, &units, Some(&at.s.force));
                let values = all.iter().map(|(_, value, _)| value(&mechanism, &there));
                values.collect::<Vec<_>>()
            });
            for (square, (plus, minus)) in squares.iter_mut().zip(plus.iter().zip(&minus)) {
                *square += ((plus - minus) / (2.0 * h)).powi(2);
            }
        }
        for (largest, square) in largest.iter_mut().zip(squares) {
            *largest = largest.max(square.sqrt() * moved);
        }
    }
    largest
}

/// Returns the number of compared numbers of a mechanism. It is zero in three cases: if its bodies
/// are not connected, so that each set has its own size and loads; if it has no decided rank; or if
/// it is nearly singular.
fn compare(mechanism: &Mechanism, draw: &mut Draw, what: &str) -> usize {
    let (q, _) = mechanism.described_state();
    let groups: Vec<usize> = (0..mechanism.layout().groups.len()).collect();
    if mechanism.joined(&groups).len() > 1 {
        return 0;
    }
    let analysis = crate::analyse(mechanism, 0.0, &q).expect("finite");
    let sigma = analysis.evidence().sigma_r;
    if !analysis.decision.is_decided() || sigma < 0.02 {
        return 0;
    }
    let kept = &analysis.decision.kept;
    let size = model::start::scene_size(mechanism, &q);
    let units = units(mechanism, size);
    let moves: Vec<f64> = q.iter().map(|_| draw.next()).collect();
    let v = &moves[..mechanism.layout().n_v.min(moves.len())];
    let at = follow(mechanism, (&q, v), kept, &units, None);
    let all = asked(mechanism);
    let numbers: Vec<ReactionNumber> = all.iter().map(|(number, ..)| number.clone()).collect();
    let found = analysis.sensitivities_of(mechanism, &at.q, &at.v, &numbers);
    let found = found.expect("fits");
    let expected = expected(mechanism, &at, kept, &all);
    // The largest applied or inertial load on a body.
    let space = mechanism.space();
    let half = space.n_translations();
    let inertial = mechanism.inertia(&at.s).product(&at.a);
    let length = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let loads = [&inertial, &at.s.force].into_iter().flat_map(|load| {
        let bodies = load.chunks_exact(space.n_v());
        bodies.map(|f| length(&f[..half]).max(length(&f[half..]) / size))
    });
    let load = loads.fold(0.0, f64::max);
    let share = |(k, (_, value, is_moment)): (usize, &Asked)| {
        let unit = if *is_moment { size } else { 1.0 };
        expected[k] / value(mechanism, &at).abs().max(load * unit)
    };
    let shares: Vec<f64> = all.iter().enumerate().map(share).collect();
    // Near a limit position, the changes are those of the displaced mechanism, which are larger.
    let first_order = crate::limits::FIRST_ORDER;
    let is_curved = sigma < 0.1 && shares.iter().any(|share| *share > 0.99 * first_order);
    for (k, expected) in shares.into_iter().enumerate() {
        let own = found[k].as_ref().expect("known");
        let groups = mechanism.layout().groups.iter();
        let kinds: Vec<_> = groups.map(|g| g.spec.common.name).collect();
        let more = if is_curved {
            expected.max(first_order)
        } else {
            0.0
        };
        let permitted = AGREEMENT * expected + ROUNDING;
        assert!(
            (-permitted..=permitted + more).contains(&(own.change - expected)),
            "{what}, {kinds:?}, number {k}: {own:?} instead of {expected}; {:?}, rows {kept:?}",
            all[k].0
        );
    }
    all.len()
}

#[test]
fn numbers_change_as_those_of_mechanisms_built_with_other_data() {
    let (mut of_plane, mut of_space) = (0, 0);
    for seed in 0..60 {
        let mut draw = Draw(1 + seed);
        let mechanism = plane(&mut draw, 0.0);
        of_plane += compare(&mechanism, &mut draw, &format!("plane {seed}"));
        let mut draw = Draw(1 + seed);
        let mechanism = plane(&mut draw, 1.0);
        of_plane += compare(
            &mechanism,
            &mut draw,
            &format!("plane with armatures {seed}"),
        );
    }
    for seed in 0..15 {
        let mut draw = Draw(1001 + seed);
        let mechanism = spatial(&mut draw);
        of_space += compare(&mechanism, &mut draw, &format!("space {seed}"));
    }
    assert!(of_plane > 200 && of_space > 150, "{of_plane} {of_space}");
}
