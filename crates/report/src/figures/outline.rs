//! Outlines of bodies: convex hulls of their points.
//!
//! A figure uses the hull of the points in the picture. A page of a spatial mechanism uses the hull
//! of the points in space.

/// Returns the corners of the convex hull, counter-clockwise in the given axes. Points on the sides
/// of the hull are omitted. For one or two points, returns these points.
pub(super) fn hull(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut hull = half(sorted.iter());
    hull.pop();
    hull.extend(half(sorted.iter().rev()));
    hull.pop();
    hull
}

/// One of the two chains of the hull (Andrew 1979).
fn half<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> Vec<[f64; 2]> {
    let mut chain: Vec<[f64; 2]> = Vec::new();
    for &p in points {
        while let [.., a, b] = chain[..] {
            if cross(a, b, p) > 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(p);
    }
    chain
}

fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Twice the area of a polygon.
pub(super) fn double_area(hull: &[[f64; 2]]) -> f64 {
    let next = hull.iter().cycle().skip(1);
    let sides = hull.iter().zip(next);
    sides.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hull_of_a_square_with_points_inside_and_on_sides() {
        let points = [
            [0.0, 0.0],
            [1.0, 1.0],
            [2.0, 0.0],
            [1.0, 0.0],
            [2.0, 2.0],
            [0.0, 2.0],
            [0.0, 0.0],
        ];
        let hull = hull(&points);
        assert_eq!(hull, [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
        assert_eq!(double_area(&hull), 8.0);
    }

    #[test]
    fn points_on_a_line_become_their_ends() {
        assert_eq!(
            hull(&[[1.0, 1.0], [0.0, 0.0], [2.0, 2.0]]),
            [[0.0, 0.0], [2.0, 2.0]]
        );
        assert_eq!(hull(&[[1.0, 1.0], [1.0, 1.0]]), [[1.0, 1.0]]);
        assert!(hull(&[]).is_empty());
    }
}
