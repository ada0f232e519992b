//! The canonical order of terms and factors. The order depends on the structure, not on the order
//! of construction or on a hash. Therefore equal expressions are printed as equal bytes.

use std::cmp::Ordering;

use crate::graph::{Expr, Graph, Node};

/// Compares two factors in the order of factors: constants, inputs (in order of first use),
/// functions, products, sums.
pub(crate) fn compare(g: &Graph, a: Expr, b: Expr) -> Ordering {
    if a == b {
        return Ordering::Equal;
    }
    match (g.node(a), g.node(b)) {
        (Node::Number(x), Node::Number(y)) => x.total_cmp(y),
        (Node::Symbol(x), Node::Symbol(y)) => x.cmp(y),
        (Node::Call(f, u), Node::Call(h, v)) => f.cmp(h).then_with(|| compare(g, *u, *v)),
        (Node::Product(x, f), Node::Product(y, h)) => {
            lexicographic(f, h, |p, q| compare(g, p.0, q.0).then(p.1.cmp(&q.1)))
                .then(x.total_cmp(y))
        }
        (Node::Sum(s), Node::Sum(t)) => {
            lexicographic(s, t, |p, q| compare(g, p.1, q.1).then(p.0.total_cmp(&q.0)))
        }
        (x, y) => kind(x).cmp(&kind(y)),
    }
}

/// Compares two terms in the order of the terms of a sum. The order is that of [`compare`], with a
/// constant last.
pub(crate) fn compare_terms(g: &Graph, a: Expr, b: Expr) -> Ordering {
    let constant = |e| g.as_number(e).is_some();
    constant(a).cmp(&constant(b)).then_with(|| compare(g, a, b))
}

fn kind(node: &Node) -> u8 {
    match node {
        Node::Number(_) => 0,
        Node::Symbol(_) => 1,
        Node::Call(..) => 2,
        Node::Product(..) => 3,
        Node::Sum(_) => 4,
    }
}

fn lexicographic<T>(a: &[T], b: &[T], compare: impl Fn(&T, &T) -> Ordering) -> Ordering {
    a.iter()
        .zip(b)
        .map(|(x, y)| compare(x, y))
        .find(|o| o.is_ne())
        .unwrap_or_else(|| a.len().cmp(&b.len()))
}
