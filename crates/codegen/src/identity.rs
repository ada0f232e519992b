//! Is an expression zero for every pose? Decided by evaluation at fixed pseudo-random points that respect
//! `cos² + sin² = 1` and unit directions; used only to leave structural zeros out of patterns.

use symbolic::{Expr, Graph};

use crate::elaborate::{Inputs, Source};

/// Points tried; a polynomial that is not zero vanishes at all of them with probability zero.
const POINTS: u64 = 6;

/// Rounding of a sum of order-one terms, with room for cancellation.
const ROUNDING: f64 = 1e-12;

/// Whether `e` vanishes at every configuration.
pub(crate) fn is_zero(g: &Graph, inputs: &Inputs, e: Expr) -> bool {
    g.is_zero(e)
        || (0..POINTS).all(|point| {
            let value = g.evaluate(e, &|s| {
                let angle = |key: &str| 6.0 * sample(point, key);
                let name = g.name(s);
                match inputs.source(s) {
                    Source::Pose { slot, field: "cos" } => angle(&slot.to_string()).cos(),
                    Source::Pose { slot, field: "sin" } => angle(&slot.to_string()).sin(),
                    Source::Pose {
                        slot,
                        field: "angle",
                    } => angle(&slot.to_string()),
                    Source::Parameter { access } if access.contains(".xy()") => {
                        let direction = angle(access.split('.').nth(1).unwrap_or_default());
                        if access.ends_with("[0]") {
                            direction.cos()
                        } else {
                            direction.sin()
                        }
                    }
                    _ => 0.5 + sample(point, name),
                }
            });
            value.abs() < ROUNDING
        })
}

/// A number in [0, 1) that depends on nothing but its arguments (FNV-1a).
fn sample(point: u64, key: &str) -> f64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64 ^ point.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    for byte in key.bytes() {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    }
    hash ^= hash >> 29;
    (hash.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 11) as f64 / (1_u64 << 53) as f64
}
