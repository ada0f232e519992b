//! Outlines of bodies: the convex hull of their points, with a rounded margin around it. Works on
//! the page (px).

use super::svg::number;

/// Convex hull, counter-clockwise in the axes given, without points on its sides. One or two points
/// are their own hull.
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
    sides(hull).map(|[a, b]| a[0] * b[1] - a[1] * b[0]).sum()
}

/// Sides of a closed polygon.
pub(super) fn sides(hull: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    let next = hull.iter().cycle().skip(1);
    hull.iter().zip(next).map(|(a, b)| [*a, *b])
}

/// Path data of the hull with a margin of `radius` and round corners.
pub(super) fn rounded(hull: &[[f64; 2]], radius: f64) -> String {
    let r = number(radius);
    if let [[x, y]] = hull {
        let (x0, x1, y) = (number(x - radius), number(x + radius), number(*y));
        return format!("M{x0},{y} A{r},{r} 0 1 1 {x1},{y} A{r},{r} 0 1 1 {x0},{y} Z");
    }
    let mut d = String::new();
    for [a, b] in sides(hull) {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let normal = [(b[1] - a[1]) / length, (a[0] - b[0]) / length];
        let shifted = |p: [f64; 2]| {
            format!(
                "{},{}",
                number(p[0] + radius * normal[0]),
                number(p[1] + radius * normal[1])
            )
        };
        if d.is_empty() {
            d = format!("M{}", shifted(a));
        } else {
            d += &format!(" A{r},{r} 0 0 1 {}", shifted(a));
        }
        d += &format!(" L{}", shifted(b));
    }
    // Back to the beginning around the last corner.
    let first = d[1..].split(' ').next().unwrap_or_default().to_owned();
    format!("{d} A{r},{r} 0 0 1 {first} Z")
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

    #[test]
    fn a_rounded_line_is_a_capsule() {
        assert_eq!(
            rounded(&[[0.0, 0.0], [10.0, 0.0]], 2.0),
            "M0,-2 L10,-2 A2,2 0 0 1 10,2 L0,2 A2,2 0 0 1 0,-2 Z"
        );
    }
}
