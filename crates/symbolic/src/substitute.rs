//! Replaces inputs by expressions.

use std::collections::HashMap;

use crate::graph::{Expr, Graph, Node};

impl Graph {
    /// Returns `e` in canonical form after each input of `pairs` is replaced by the second entry of
    /// its pair.
    pub fn substitute(&mut self, e: Expr, pairs: &[(Expr, Expr)]) -> Expr {
        let mut done = pairs.iter().copied().collect();
        self.rebuild(e, &mut done)
    }

    fn rebuild(&mut self, e: Expr, done: &mut HashMap<Expr, Expr>) -> Expr {
        if let Some(&r) = done.get(&e) {
            return r;
        }
        let r = match self.node(e).clone() {
            Node::Number(_) | Node::Symbol(_) => e,
            Node::Sum(terms) => {
                let terms: Vec<_> = terms
                    .into_iter()
                    .map(|(c, t)| (c, self.rebuild(t, done)))
                    .collect();
                self.sum(&terms)
            }
            Node::Product(c, factors) => {
                let factors: Vec<_> = factors
                    .into_iter()
                    .map(|(f, n)| (self.rebuild(f, done), n))
                    .collect();
                self.product(c, &factors)
            }
            Node::Call(f, u) => {
                let u = self.rebuild(u, done);
                self.call(f, u)
            }
        };
        done.insert(e, r);
        r
    }
}
