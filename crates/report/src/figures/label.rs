//! Positions names so that they do not overlap. Each name is placed at the best of several
//! positions around its anchor. The animation of a page uses the same rule.

use super::svg::text_width;

/// A rectangle of the page (px).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub(super) centre: [f64; 2],
    pub(super) half: [f64; 2],
}

impl Rect {
    /// Area of the overlap with another rectangle.
    pub(super) fn overlap(&self, other: &Self) -> f64 {
        let along = |k: usize| {
            let reach = self.half[k] + other.half[k] - (self.centre[k] - other.centre[k]).abs();
            reach.clamp(0.0, 2.0 * self.half[k].min(other.half[k]))
        };
        along(0) * along(1)
    }

    fn is_inside(&self, page: &Self) -> bool {
        let reach = |k: usize| (self.centre[k] - page.centre[k]).abs() + self.half[k];
        reach(0) <= page.half[0] && reach(1) <= page.half[1]
    }
}

/// A name that needs a position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Request<'a> {
    pub(super) text: &'a str,
    pub(super) size: f64,
    pub(super) anchor: [f64; 2],
}

/// Distances from the anchor (px).
const DISTANCES: [f64; 4] = [14.0, 24.0, 36.0, 52.0];
/// Directions from the anchor, with y downwards: upper right, upper left, lower right, lower left,
/// above, below. If several positions are equally good, the first of these directions is used.
const DIRECTIONS: [[f64; 2]; 6] = [
    [1.0, -0.6],
    [-1.0, -0.6],
    [1.0, 0.8],
    [-1.0, 0.8],
    [0.0, -1.0],
    [0.0, 1.0],
];

/// Returns the positions of names, which are placed in the given order. A position is `None` if, at
/// every candidate position, the name would overlap another name or leave the page.
pub(super) fn place(page: &Rect, symbols: &[Rect], requests: &[Request<'_>]) -> Vec<Option<Rect>> {
    let mut taken: Vec<Rect> = Vec::new();
    let mut places = Vec::with_capacity(requests.len());
    for request in requests {
        let hidden = |rect: &Rect| -> f64 {
            let others = taken.iter().chain(symbols);
            others.map(|other| other.overlap(rect)).sum()
        };
        let best = candidates(request)
            .filter(|rect| rect.is_inside(page))
            .filter(|rect| taken.iter().all(|t| t.overlap(rect) == 0.0))
            .map(|rect| (hidden(&rect), rect))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, rect)| rect);
        taken.extend(best);
        places.push(best);
    }
    places
}

/// Returns positions around the anchor. The nearest positions come first.
fn candidates(request: &Request<'_>) -> impl Iterator<Item = Rect> {
    let Request { text, size, anchor } = *request;
    let half = [0.5 * text_width(text, size) + 1.5, 0.5 * size + 1.0];
    DISTANCES.into_iter().flat_map(move |d| {
        DIRECTIONS.into_iter().map(move |[x, y]| Rect {
            centre: [
                anchor[0] + x * (d + half[0]),
                anchor[1] + y * d + y.signum() * 0.5 * half[1],
            ],
            half,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: Rect = Rect {
        centre: [200.0, 200.0],
        half: [200.0, 200.0],
    };

    fn request(text: &str) -> Request<'_> {
        Request {
            text,
            size: 12.0,
            anchor: [200.0, 200.0],
        }
    }

    #[test]
    fn names_at_one_point_do_not_overlap() {
        let symbol = Rect {
            centre: [200.0, 200.0],
            half: [8.0, 8.0],
        };
        let places = place(&PAGE, &[symbol], &[request("steering"); 8]);
        let places: Vec<Rect> = places.into_iter().flatten().collect();
        assert_eq!(places.len(), 8);
        for (k, a) in places.iter().enumerate() {
            assert_eq!(a.overlap(&symbol), 0.0);
            assert!(places[..k].iter().all(|b| a.overlap(b) == 0.0));
        }
    }

    #[test]
    fn a_crowd_loses_names_and_shows_no_overlap() {
        let places = place(&PAGE, &[], &[request("a rather long name"); 60]);
        let shown: Vec<Rect> = places.iter().copied().flatten().collect();
        assert!(shown.len() > 5 && shown.len() < 60);
        for (k, a) in shown.iter().enumerate() {
            assert!(shown[..k].iter().all(|b| a.overlap(b) == 0.0));
        }
    }
}
