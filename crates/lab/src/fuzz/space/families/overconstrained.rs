//! Loops of revolute joints that move although their rows are redundant.

use super::super::catalogue::revolute;
use super::super::drawing::Kind;
use super::super::ratio::Ratio;
use super::super::vector::{Motion, Rotation, Vector};
use super::pen::Pen;

/// The four joints of a Bennett linkage with links (a, α), (b, β), (a, α), (b, β). `first` is the
/// frame of link 1–2, with z along the axis of joint 1 and x towards joint 2.
///
/// Source: O. Bottema, B. Roth, Theoretical Kinematics (1979), ch. VII: a/sin α = b/sin β and
/// tan(θ/2)·tan(φ/2) = (tan(β/2) + tan(α/2))/(tan(β/2) − tan(α/2)) for the angles θ, φ, −θ, −φ at
/// the joints. Therefore all coordinates are rational if a and the tangents of the half angles are
/// rational.
struct Bennett {
    /// The values a, tan(α/2), tan(β/2), tan(θ/2).
    length: Ratio,
    alpha: Ratio,
    beta: Ratio,
    theta: Ratio,
}

fn sine(half: &Ratio) -> Ratio {
    let (one, two) = (Ratio::one(), Ratio::whole(2));
    &(&two * half) / &(&one + &(half * half))
}

impl Bennett {
    fn joints(&self, first: &Motion) -> [Kind; 4] {
        let k = &(&self.beta + &self.alpha) / &(&self.beta - &self.alpha);
        let phi = &k / &self.theta;
        let other = &(&self.length * &sine(&self.beta)) / &sine(&self.alpha);
        let links = [
            (&self.length, &self.alpha, phi.clone()),
            (&other, &self.beta, -&self.theta),
            (&self.length, &self.alpha, -&phi),
            (&other, &self.beta, self.theta.clone()),
        ];
        let (x, z) = (Vector::unit(0), Vector::unit(2));
        let mut frame = first.clone();
        links.map(|(length, twist, turn)| {
            let joint = revolute(&frame.shift, &frame.direction(&z));
            // The transformation to the next joint frame: translation along the link and rotation
            // about the link, then rotation about the next joint.
            let along = Motion::rigid(Rotation::about(&x, twist), x.times(length));
            let about = Motion::rigid(Rotation::about(&z, &turn), Vector::zero());
            frame = frame.after(&along).after(&about);
            joint
        })
    }
}

/// Returns a linkage that has a link with the same a and α as the linkage `like`.
fn another(pen: &mut Pen<'_>, like: Option<&Bennett>) -> Bennett {
    let (length, alpha) = match like {
        Some(b) => (b.length.clone(), b.alpha.clone()),
        None => (pen.whole(1, 4), pen.half_tangent()),
    };
    let beta = loop {
        let beta = pen.half_tangent();
        if beta.abs() != alpha.abs() {
            break beta;
        }
    };
    let theta = pen.half_tangent();
    Bennett {
        length,
        alpha,
        beta,
        theta,
    }
}

pub(super) fn bennett(pen: &mut Pen<'_>) {
    let scale = pen.step.clone();
    let first = Motion {
        scale,
        ..Motion::none()
    };
    let linkage = another(pen, None);
    let joints = linkage.joints(&first);
    match pen.numbers.below(3) {
        0 => {
            let (_, first) = pen.chain(pen.base, pen.base, &joints);
            pen.expects(3);
            pen.drives(first);
        }
        merged => {
            let other = another(pen, Some(&linkage)).joints(&first);
            goldberg(pen, joints, other, merged == 1);
        }
    }
}

/// Draws two Bennett linkages that share the link 1–2. The links 4–1 of both linkages are one body,
/// the base. If the shared link is removed, a hinge connects the other two links at joint 2. The
/// result is Goldberg's 5R linkage, with 25 rows of rank 23. With the shared link there are 35 rows
/// of rank 29. If the linkages coincide, theory gives no result.
fn goldberg(pen: &mut Pen<'_>, one: [Kind; 4], other: [Kind; 4], is_merged: bool) {
    let coincide = one[2] == other[2];
    let base = pen.base;
    let [j1, j2, j3, j4] = one;
    let [_, k2, k3, k4] = other;
    let (bodies, first) = pen.chain(base, base, &[j4, j3, j2, k3, k4]);
    if is_merged {
        pen.expects(2);
    } else {
        // The hinge at joint 2 connects to the shared link, and the hinge at joint 1 connects the
        // shared link to the base.
        let shared = pen.body();
        pen.joint([base, shared], j1);
        pen.joint([shared, bodies[2]], k2);
        pen.expects(6);
    }
    if coincide {
        pen.unknown();
    }
    pen.drives(first);
}

pub(super) fn six_bars(pen: &mut Pen<'_>) {
    match pen.numbers.below(4) {
        0 => sarrus(pen),
        1 => cube(pen),
        2 => symmetric(pen, |p| Vector([-&p.0[0], -&p.0[1], p.0[2].clone()])),
        _ => mirrored(pen),
    }
}

/// Draws a Sarrus linkage: a platform on two to four chains of three parallel revolute joints. Each
/// chain constrains the platform by one force and two couples. If the axes of two chains have
/// different directions, the platform can only translate along one line.
fn sarrus(pen: &mut Pen<'_>) {
    let n = 2 + pen.numbers.below(3);
    let (base, platform) = (pen.base, pen.body());
    let (y, mut turn) = (Vector::unit(1), Rotation::none());
    let mut first = usize::MAX;
    for k in 0..n {
        let (low, knee, high) = (pen.whole(1, 3), pen.whole(1, 4), pen.whole(1, 3));
        let zero = Ratio::zero();
        let [low, knee, high] = [
            Vector([low, zero.clone(), zero.clone()]),
            Vector([&knee + &Ratio::whole(3), zero.clone(), Ratio::new(1, 2)]),
            Vector([high, zero, Ratio::one()]),
        ];
        let axis = turn.of(&y);
        let joints = [low, knee, high].map(|p| revolute(&turn.of(&p.times(&pen.step)), &axis));
        let (_, joint) = pen.chain(base, platform, &joints);
        first = first.min(joint);
        // The second chain is never opposite to the first.
        let next = if k == 0 {
            Rotation::about(&Vector::unit(2), &Ratio::new(1, 2))
        } else {
            pen.turn_about(2)
        };
        turn = next.after(&turn);
    }
    pen.expects(3 * n - 5);
    pen.drives(first);
}

/// Draws Bricard's linkage along the edges of a cube.
fn cube(pen: &mut Pen<'_>) {
    let joints = super::super::catalogue::bricard().joints.into_iter();
    let step = pen.step.clone();
    let joints = joints.map(|j| j.kind.mapped(&|p| p.times(&step), &Vector::clone));
    let joints: Vec<Kind> = joints.collect();
    let (_, first) = pen.chain(pen.base, pen.base, &joints);
    pen.expects(1);
    pen.drives(first);
}

/// Draws Bricard's line-symmetric linkage: three axes, and the images of these axes under a half
/// turn.
fn symmetric(pen: &mut Pen<'_>, image: impl Fn(&Vector) -> Vector) {
    let own = [0; 3].map(|_| revolute(&pen.point(), &pen.direction()));
    let joints = own.each_ref().map(|j| j.mapped(&image, &image));
    let joints: Vec<Kind> = own.into_iter().chain(joints).collect();
    let (_, first) = pen.chain(pen.base, pen.base, &joints);
    // Generic linkages have p = 1. Axes with small integer components may have further special
    // positions.
    pen.unknown();
    pen.drives(first);
}

/// Draws Bricard's plane-symmetric linkage: two axes in the mirror plane, and two further axes with
/// their mirror images.
fn mirrored(pen: &mut Pen<'_>) {
    let zero = Ratio::zero();
    let mirror = |p: &Vector| Vector([p.0[0].clone(), p.0[1].clone(), -&p.0[2]]);
    let within = |pen: &mut Pen<'_>| loop {
        let (at, mut axis) = (pen.point_at(&zero), pen.direction());
        axis.0[2] = Ratio::zero();
        if !axis.is_zero() {
            return revolute(&at, &axis);
        }
    };
    let (start, end) = (within(pen), within(pen));
    let own = [0; 2].map(|_| revolute(&pen.point(), &pen.direction()));
    let [second, third] = own.each_ref().map(|j| j.mapped(&mirror, &mirror));
    let [a, b] = own;
    let (_, first) = pen.chain(pen.base, pen.base, &[start, a, b, end, third, second]);
    pen.unknown();
    pen.drives(first);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bennett_linkage_closes() {
        let linkage = Bennett {
            length: Ratio::whole(2),
            alpha: Ratio::new(1, 3),
            beta: Ratio::new(1, 2),
            theta: Ratio::new(2, 3),
        };
        let joints = linkage.joints(&Motion::none());
        let mut points = Vec::new();
        for joint in &joints {
            points.extend(joint.place().cloned());
        }
        // Opposite sides are equal.
        let side = |i: usize, j: usize| (&points[i] - &points[j]).square();
        assert_eq!(side(0, 1), Ratio::whole(4));
        assert_eq!(side(2, 3), Ratio::whole(4));
        assert_eq!(side(1, 2), side(3, 0));
    }
}
