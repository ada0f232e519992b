//! The position and the size of a drawing on its page.

use super::{LARGEST_HEIGHT, ROOM, TITLE, WIDTH};
use crate::figures::axis::{DRAWABLE, range};
use crate::figures::drawing::DrawingModel;

/// Conversion from the plane of the picture (m) to the page (px).
pub(super) struct View {
    /// Scale (px/m).
    pub(super) scale: f64,
    /// The point in the middle of the drawing.
    middle: [f64; 2],
    /// Height of the drawing (px).
    pub(super) height: f64,
}

impl View {
    pub(super) fn around(model: &DrawingModel) -> Self {
        let mut points = Vec::new();
        for (k, body) in model.bodies.iter().enumerate() {
            points.extend(body.outline.iter().map(|p| model.held(k as isize, *p)));
        }
        for site in &model.sites {
            points.push(model.at(&site.place));
            points.extend(site.end.as_ref().map(|end| model.at(end)));
            for wheel in &site.wheels {
                points.extend(model.wheel(wheel));
            }
        }
        for &(body, point) in model.forces.iter().flat_map(|f| &f.points) {
            points.push(model.held(body, point));
        }
        points.extend(model.markers.iter().map(|m| model.held(m.b, m.p)));
        let [x, y] = [0, 1].map(|k| range(points.iter().map(|p| p[k])).unwrap_or([0.0, 0.0]));
        let (dx, dy) = (x[1] - x[0], y[1] - y[0]);
        let room = [WIDTH - 2.0 * ROOM[0], LARGEST_HEIGHT - 2.0 * ROOM[1]];
        let size = dx.max(dy);
        // An extent of one metre is used if the extent of a drawing is zero or is only a rounding
        // error of the distance from the origin.
        let far = x[0].abs().max(y[0].abs());
        let scale = if size > 1e-9 * far && size > 1.0 / DRAWABLE {
            (room[0] / dx).min(room[1] / dy)
        } else {
            0.2 * room[0] / far.max(1.0)
        };
        Self {
            scale,
            middle: [x[0] + 0.5 * dx, y[0] + 0.5 * dy],
            height: (scale * dy + 2.0 * ROOM[1]).max(200.0),
        }
    }

    pub(super) fn to_page(&self, p: [f64; 2]) -> [f64; 2] {
        [
            0.5 * WIDTH + self.scale * (p[0] - self.middle[0]),
            TITLE + 0.5 * self.height - self.scale * (p[1] - self.middle[1]),
        ]
    }

    pub(super) fn bottom(&self) -> f64 {
        TITLE + self.height
    }
}
