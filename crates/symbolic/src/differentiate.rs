//! Exact derivatives. A derivation is defined by its values for the inputs. All other values follow
//! from the sum, product and chain rules. A partial derivative, a derivative along a rotation (`cos
//! ↦ −sin`, `sin ↦ cos`) and a total time derivative differ only in the values for the inputs.

use std::collections::{BTreeMap, HashMap};

use crate::graph::{Expr, Function, Graph, Node, Symbol};

/// A derivation `D`, defined by the image `D(s)` of each input. Inputs that are not listed are
/// constants.
///
/// ```
/// use pfaff_symbolic::{Derivation, Graph};
/// let mut g = Graph::new();
/// let (cos, sin, a, b) = (g.symbol("cos"), g.symbol("sin"), g.symbol("a"), g.symbol("b"));
/// let minus_sin = g.neg(sin);
/// let turn = Derivation::new(&g, &[(cos, minus_sin), (sin, cos)]);
/// // x = a·cos − b·sin, y = a·sin + b·cos: D(x) = −y, the same node.
/// let (ac, bs, as_, bc) = (g.mul(a, cos), g.mul(b, sin), g.mul(a, sin), g.mul(b, cos));
/// let x = g.sub(ac, bs);
/// let y = g.add(as_, bc);
/// let minus_y = g.neg(y);
/// assert_eq!(turn.apply(&mut g, x), minus_y);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Derivation {
    images: BTreeMap<Symbol, Expr>,
}

impl Derivation {
    /// Creates the derivation with these images of inputs.
    ///
    /// # Panics
    /// Panics if the first entry of a pair is not an input of `g`.
    #[must_use]
    pub fn new(g: &Graph, images: &[(Expr, Expr)]) -> Self {
        let images = images
            .iter()
            .map(|&(s, image)| {
                let s = g
                    .as_symbol(s)
                    .expect("a derivation is given by images of inputs");
                (s, image)
            })
            .collect();
        Self { images }
    }

    /// Returns the derivation with these additional images.
    ///
    /// # Panics
    /// Panics under the same conditions as [`Derivation::new`].
    #[must_use]
    pub fn with(&self, g: &Graph, images: &[(Expr, Expr)]) -> Self {
        let mut all = Self::new(g, images);
        all.images.extend(&self.images);
        all
    }

    /// Returns the partial derivative with respect to one input.
    #[must_use]
    pub fn partial(g: &mut Graph, by: Expr) -> Self {
        let one = g.number(1.0);
        Self::new(g, &[(by, one)])
    }

    /// Returns `D(e)`.
    pub fn apply(&self, g: &mut Graph, e: Expr) -> Expr {
        self.derive(g, e, &mut HashMap::new())
    }

    fn derive(&self, g: &mut Graph, e: Expr, done: &mut HashMap<Expr, Expr>) -> Expr {
        if let Some(&d) = done.get(&e) {
            return d;
        }
        let d = match g.node(e).clone() {
            Node::Number(_) => g.number(0.0),
            Node::Symbol(s) => match self.images.get(&s) {
                Some(&image) => image,
                None => g.number(0.0),
            },
            Node::Sum(terms) => {
                let terms: Vec<_> = terms
                    .into_iter()
                    .map(|(c, t)| (c, self.derive(g, t, done)))
                    .collect();
                g.sum(&terms)
            }
            Node::Product(c, factors) => {
                // The derivative is Σ_k n_k · D(f_k)/f_k · product.
                let terms: Vec<_> = (0..factors.len())
                    .map(|k| {
                        let (base, n) = factors[k];
                        let mut rest = factors.clone();
                        rest[k].1 -= 1;
                        rest.push((self.derive(g, base, done), 1));
                        (f64::from(n), g.product(c, &rest))
                    })
                    .collect();
                g.sum(&terms)
            }
            Node::Call(f, u) => {
                let du = self.derive(g, u, done);
                let outer = match f {
                    // The value is zero at zero. Therefore the length of a vector has a finite
                    // derivative if the vector is zero.
                    Function::Sqrt => {
                        let recip = g.call(Function::RecipOrZero, e);
                        g.product(0.5, &[(recip, 1)])
                    }
                    Function::RecipOrZero => g.product(-1.0, &[(e, 2)]),
                    Function::Sin => g.call(Function::Cos, u),
                    Function::Cos => {
                        let sin = g.call(Function::Sin, u);
                        g.neg(sin)
                    }
                    Function::AngleOverSine(order) => {
                        g.call(Function::AngleOverSine(order.saturating_add(1)), u)
                    }
                };
                g.mul(outer, du)
            }
        };
        done.insert(e, d);
        d
    }
}
