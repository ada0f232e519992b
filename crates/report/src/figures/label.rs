//! Places for names so that none hides another: each takes the best of many places around its
//! anchor.

use super::svg::text_width;

/// A rectangle of the page (px).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub(super) centre: [f64; 2],
    pub(super) half: [f64; 2],
}

impl Rect {
    /// Area of the overlap with another.
    pub(super) fn overlap(&self, other: &Self) -> f64 {
        let along = |k: usize| {
            let reach = self.half[k] + other.half[k] - (self.centre[k] - other.centre[k]).abs();
            reach.clamp(0.0, 2.0 * self.half[k].min(other.half[k]))
        };
        along(0) * along(1)
    }

    /// Length of the part of a segment inside.
    fn cut(&self, [a, b]: [[f64; 2]; 2]) -> f64 {
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for k in 0..2 {
            let (start, step) = (a[k] - self.centre[k], b[k] - a[k]);
            if step == 0.0 {
                if start.abs() > self.half[k] {
                    return 0.0;
                }
                continue;
            }
            let ends = [
                (-self.half[k] - start) / step,
                (self.half[k] - start) / step,
            ];
            from = from.max(ends[0].min(ends[1]));
            to = to.min(ends[0].max(ends[1]));
        }
        (to - from).max(0.0) * (b[0] - a[0]).hypot(b[1] - a[1])
    }

    fn excess(&self, page: &Self) -> f64 {
        (0..2)
            .map(|k| {
                let reach = (self.centre[k] - page.centre[k]).abs() + self.half[k];
                (reach - page.half[k]).max(0.0)
            })
            .sum()
    }
}

/// A name that wants a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Request<'a> {
    pub(super) text: &'a str,
    pub(super) size: f64,
    pub(super) anchor: [f64; 2],
    /// Half the sides of what is at the anchor.
    pub(super) half: [f64; 2],
}

/// Distances from what is at the anchor (px).
const DISTANCES: [f64; 6] = [3.0, 9.0, 18.0, 30.0, 46.0, 66.0];
/// Directions, evenly around the anchor.
const DIRECTIONS: usize = 16;
/// Costs: of a px² of overlap with names and symbols, of a px of a line behind the text, of a px
/// outside the page, of a px of distance.
const OVERLAP: f64 = 8.0;
const LINE: f64 = 1.6;
const OUTSIDE: f64 = 500.0;
const DISTANCE: f64 = 0.6;

/// What names should keep clear of.
pub(super) struct Field<'a> {
    pub(super) page: Rect,
    pub(super) symbols: &'a [Rect],
    pub(super) lines: &'a [[[f64; 2]; 2]],
}

/// Places names in the order given; `None` where every place would hide another name or leave the
/// page.
pub(super) fn place(field: &Field<'_>, requests: &[Request<'_>]) -> Vec<Option<Rect>> {
    let mut taken: Vec<Rect> = Vec::new();
    let mut places = Vec::with_capacity(requests.len());
    for request in requests {
        let cost = |(rect, distance): &(Rect, f64)| {
            let among = |rects: &[Rect]| rects.iter().map(|r| r.overlap(rect)).sum::<f64>();
            let lines: f64 = field.lines.iter().map(|l| rect.cut(*l)).sum();
            OVERLAP * (among(&taken) + among(field.symbols))
                + LINE * lines
                + OUTSIDE * rect.excess(&field.page)
                + DISTANCE * distance
        };
        let best = candidates(request)
            .map(|c| (cost(&c), c.0))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, rect)| rect)
            .filter(|rect| rect.excess(&field.page) == 0.0)
            .filter(|rect| taken.iter().all(|t| t.overlap(rect) == 0.0));
        taken.extend(best);
        places.push(best);
    }
    places
}

/// Places around the anchor with their distances; the upper right comes first among equals.
fn candidates(request: &Request<'_>) -> impl Iterator<Item = (Rect, f64)> {
    let Request {
        text,
        size,
        anchor,
        half: at,
    } = *request;
    let half = [0.5 * text_width(text, size) + 1.5, 0.5 * size + 1.0];
    DISTANCES.into_iter().flat_map(move |d| {
        (0..DIRECTIONS).map(move |k| {
            let angle = std::f64::consts::TAU * (k as f64 / DIRECTIONS as f64 + 0.125);
            let (sin, cos) = angle.sin_cos();
            let centre = [
                anchor[0] + cos * (at[0] + half[0] + d),
                anchor[1] - sin * (at[1] + half[1] + d),
            ];
            (Rect { centre, half }, d)
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

    #[test]
    fn names_at_one_point_do_not_overlap() {
        let request = Request {
            text: "steering",
            size: 12.0,
            anchor: [200.0, 200.0],
            half: [8.0, 8.0],
        };
        let symbols = [Rect {
            centre: request.anchor,
            half: request.half,
        }];
        let field = Field {
            page: PAGE,
            symbols: &symbols,
            lines: &[],
        };
        let places: Vec<Rect> = place(&field, &[request; 8]).into_iter().flatten().collect();
        assert_eq!(places.len(), 8);
        for (k, a) in places.iter().enumerate() {
            assert_eq!(a.overlap(&symbols[0]), 0.0);
            assert!(places[..k].iter().all(|b| a.overlap(b) == 0.0));
        }
    }

    #[test]
    fn a_crowd_loses_names_and_shows_no_overlap() {
        let request = Request {
            text: "a rather long name",
            size: 12.0,
            anchor: [200.0, 200.0],
            half: [8.0, 8.0],
        };
        let field = Field {
            page: PAGE,
            symbols: &[],
            lines: &[],
        };
        let places = place(&field, &[request; 60]);
        let shown: Vec<Rect> = places.iter().copied().flatten().collect();
        assert!(shown.len() > 5 && shown.len() < 60);
        for (k, a) in shown.iter().enumerate() {
            assert!(shown[..k].iter().all(|b| a.overlap(b) == 0.0));
        }
    }

    #[test]
    fn lengths_inside_a_rectangle() {
        let rect = Rect {
            centre: [0.0, 0.0],
            half: [2.0, 1.0],
        };
        assert_eq!(rect.cut([[-4.0, 0.0], [4.0, 0.0]]), 4.0);
        assert_eq!(rect.cut([[0.0, 0.5], [0.0, 4.5]]), 0.5);
        assert_eq!(rect.cut([[-5.0, 3.0], [5.0, 3.0]]), 0.0);
    }
}
