//! Expressions as nodes of one graph. Every constructor returns the canonical form, so that equal
//! expressions have equal handles, and a derivative shares the subexpressions of its original.
//!
//! The constructors apply these simplifications: like terms and like factors are merged, and
//! operations on constants are performed. A factor common to all terms of a sum is moved out of it.
//! The first term of a sum is positive, and `√u²` is `u`. Products are never multiplied out. Nested
//! sums stay nested unless terms cancel, because the nesting in a definition determines the shared
//! values of its kernel.
//!
//! Operations on constants are performed in `f64`, in the order of construction. If the
//! coefficients are not binary fractions, two groupings of the same constants may differ in the
//! last digit, and are then two different expressions.
//!
//! Common factors are moved out of sums. Therefore the derivatives of a rotated arm are the same
//! nodes as the arm itself.

use std::collections::HashMap;

use rotation::angle_over_sine;

use crate::order;

/// Handle of an expression. In one [`Graph`], equal handles mean equal expressions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Expr(u32);

/// Handle of a named input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Symbol(u32);

impl Symbol {
    /// Returns the index of the input among the inputs of its graph, in the order of first use.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Functions of one argument that are not polynomials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Function {
    /// The square root `√u`.
    Sqrt,
    /// The sine `sin u`.
    Sin,
    /// The cosine `cos u`.
    Cos,
    /// The reciprocal `1/u`, and 0 for `u = 0`. With this rule, the direction of a vector of length
    /// zero is zero.
    RecipOrZero,
    /// The derivative of the given order of θ/sin θ with respect to u = cos θ, see
    /// [`angle_over_sine`].
    AngleOverSine(u8),
}

/// One node of the graph, in canonical form.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// A constant.
    Number(f64),
    /// A named input.
    Symbol(Symbol),
    /// A sum `Σ coefficient · term` with at least two terms. The terms are sorted, and the first
    /// coefficient is positive. A constant term is a multiple of the number 1.
    Sum(Vec<(f64, Expr)>),
    /// A product `coefficient · Π base^exponent`, sorted.
    Product(f64, Vec<(Expr, i32)>),
    /// A function of one argument.
    Call(Function, Expr),
}

/// Key of a node in the hash-consing table: the node with its constants as bits.
#[derive(PartialEq, Eq, Hash)]
enum Key {
    Number(u64),
    Symbol(Symbol),
    Sum(Vec<(u64, Expr)>),
    Product(u64, Vec<(Expr, i32)>),
    Call(Function, Expr),
}

/// A set of expressions over named inputs.
///
/// ```
/// use pfaff_symbolic::Graph;
/// let mut g = Graph::new();
/// let (x, y) = (g.symbol("x"), g.symbol("y"));
/// let a = g.add(x, y);
/// let b = g.add(y, x);
/// assert_eq!(a, b);
/// let zero = g.sub(a, b);
/// assert!(g.is_zero(zero));
/// ```
#[derive(Default)]
pub struct Graph {
    nodes: Vec<Node>,
    table: HashMap<Key, Expr>,
    names: Vec<String>,
}

impl Graph {
    /// Returns an empty graph.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the node that a handle refers to.
    #[must_use]
    pub fn node(&self, e: Expr) -> &Node {
        &self.nodes[e.0 as usize]
    }

    /// Returns the name of an input.
    #[must_use]
    pub fn name(&self, s: Symbol) -> &str {
        &self.names[s.0 as usize]
    }

    /// Returns the input called `name`, which is created at its first use. Inputs are ordered by
    /// first use.
    pub fn symbol(&mut self, name: &str) -> Expr {
        let id = match self.names.iter().position(|n| n == name) {
            Some(k) => Symbol(k as u32),
            None => {
                self.names.push(name.to_owned());
                Symbol(self.names.len() as u32 - 1)
            }
        };
        self.intern(Node::Symbol(id))
    }

    /// Returns the expression of an input.
    ///
    /// # Panics
    /// Panics if the input belongs to another graph.
    #[must_use]
    pub fn symbol_expr(&self, s: Symbol) -> Expr {
        let known = self.table.get(&Key::Symbol(s));
        *known.expect("an input of this graph")
    }

    /// Returns the input that a handle refers to, if the handle refers to an input.
    #[must_use]
    pub fn as_symbol(&self, e: Expr) -> Option<Symbol> {
        match self.node(e) {
            Node::Symbol(s) => Some(*s),
            _ => None,
        }
    }

    /// Returns the constant that a handle refers to, if the handle refers to a constant.
    #[must_use]
    pub fn as_number(&self, e: Expr) -> Option<f64> {
        match self.node(e) {
            Node::Number(x) => Some(*x),
            _ => None,
        }
    }

    /// Returns whether the expression is the constant 0 in canonical form.
    #[must_use]
    pub fn is_zero(&self, e: Expr) -> bool {
        self.as_number(e) == Some(0.0)
    }

    /// Returns the inputs that the expression depends on, in the order of their first use in the
    /// graph.
    #[must_use]
    pub fn inputs(&self, e: Expr) -> Vec<Symbol> {
        let mut seen = std::collections::BTreeSet::new();
        let mut found = std::collections::BTreeSet::new();
        let mut stack = vec![e];
        while let Some(e) = stack.pop() {
            if seen.insert(e) {
                if let Node::Symbol(s) = self.node(e) {
                    found.insert(*s);
                }
                stack.extend(self.children(e));
            }
        }
        found.into_iter().collect()
    }

    /// Returns the operands of a node.
    #[must_use]
    pub fn children(&self, e: Expr) -> Vec<Expr> {
        match self.node(e) {
            Node::Number(_) | Node::Symbol(_) => Vec::new(),
            Node::Sum(terms) => terms.iter().map(|t| t.1).collect(),
            Node::Product(_, factors) => factors.iter().map(|f| f.0).collect(),
            Node::Call(_, u) => vec![*u],
        }
    }

    /// Returns a constant.
    pub fn number(&mut self, x: f64) -> Expr {
        // The values −0 and 0 are one constant.
        self.intern(Node::Number(if x == 0.0 { 0.0 } else { x }))
    }

    /// Returns `a + b`.
    pub fn add(&mut self, a: Expr, b: Expr) -> Expr {
        self.sum(&[(1.0, a), (1.0, b)])
    }

    /// Returns `a − b`.
    pub fn sub(&mut self, a: Expr, b: Expr) -> Expr {
        self.sum(&[(1.0, a), (-1.0, b)])
    }

    /// Returns `−a`.
    pub fn neg(&mut self, a: Expr) -> Expr {
        self.product(-1.0, &[(a, 1)])
    }

    /// Returns `a · b`.
    pub fn mul(&mut self, a: Expr, b: Expr) -> Expr {
        self.product(1.0, &[(a, 1), (b, 1)])
    }

    /// Returns `a / b`.
    pub fn div(&mut self, a: Expr, b: Expr) -> Expr {
        self.product(1.0, &[(a, 1), (b, -1)])
    }

    /// Returns `f(u)`.
    pub fn call(&mut self, f: Function, u: Expr) -> Expr {
        match (f, self.as_number(u)) {
            (Function::Sqrt, Some(x)) if x >= 0.0 => self.number(x.sqrt()),
            (Function::Sin, Some(0.0)) => self.number(0.0),
            (Function::Cos, Some(0.0)) => self.number(1.0),
            (Function::RecipOrZero, Some(0.0)) => self.number(0.0),
            (Function::RecipOrZero, Some(x)) => self.number(1.0 / x),
            (Function::AngleOverSine(order), Some(x)) => self.number(angle_over_sine(x, order)),
            _ => self.intern(Node::Call(f, u)),
        }
    }

    /// Returns `coefficient · Π base^exponent`.
    pub fn product(&mut self, coefficient: f64, factors: &[(Expr, i32)]) -> Expr {
        let mut c = coefficient;
        let mut merged: Vec<(Expr, i32)> = Vec::new();
        let mut stack: Vec<(Expr, i32)> = factors.iter().rev().copied().collect();
        while let Some((e, k)) = stack.pop() {
            match self.node(e) {
                Node::Number(x) if *x != 0.0 || k >= 0 => c *= power(*x, k),
                Node::Product(x, inner) => {
                    c *= power(*x, k);
                    stack.extend(inner.iter().map(|(f, n)| (*f, n * k)));
                }
                _ => match merged.iter_mut().find(|f| f.0 == e) {
                    Some(f) => f.1 += k,
                    None => merged.push((e, k)),
                },
            }
        }
        // The product √u · √u is u.
        if let Some(at) = merged.iter().position(|(e, k)| {
            k.abs() > 1 && matches!(self.node(*e), Node::Call(Function::Sqrt, _))
        }) {
            let (e, k) = merged[at];
            let Node::Call(_, u) = *self.node(e) else {
                unreachable!("position() found a square root")
            };
            merged[at].1 = k % 2;
            merged.push((u, k / 2));
            return self.product(c, &merged);
        }
        merged.retain(|f| f.1 != 0);
        if c == 0.0 || merged.is_empty() {
            return self.number(c);
        }
        if c == 1.0 && merged.len() == 1 && merged[0].1 == 1 {
            return merged[0].0;
        }
        merged.sort_by(|a, b| order::compare(self, a.0, b.0).then(a.1.cmp(&b.1)));
        self.intern(Node::Product(c, merged))
    }

    /// Returns `Σ coefficient · term`.
    pub fn sum(&mut self, terms: &[(f64, Expr)]) -> Expr {
        let mut list = Vec::new();
        for &(c, e) in terms {
            self.accumulate(&mut list, c, e);
        }
        self.open_cancelling_sums(&mut list);
        list.retain(|t| t.0 != 0.0);
        match list.len() {
            0 => return self.number(0.0),
            1 => return self.product(list[0].0, &[(list[0].1, 1)]),
            _ => {}
        }
        let common = self.common_factors(&list);
        if !common.is_empty() {
            let inverse: Vec<_> = common.iter().map(|(e, k)| (*e, -k)).collect();
            let rest: Vec<_> = list
                .iter()
                .map(|&(c, e)| {
                    let mut factors = vec![(e, 1)];
                    factors.extend(&inverse);
                    (c, self.product(1.0, &factors))
                })
                .collect();
            let inner = self.sum(&rest);
            let mut factors = vec![(inner, 1)];
            factors.extend(common);
            return self.product(1.0, &factors);
        }
        list.sort_by(|a, b| order::compare_terms(self, a.1, b.1));
        let same_size = list.iter().all(|t| t.0.abs() == list[0].0.abs());
        let content = list[0].0.signum() * if same_size { list[0].0.abs() } else { 1.0 };
        for t in &mut list {
            t.0 /= content;
        }
        let sum = self.intern(Node::Sum(list));
        self.product(content, &[(sum, 1)])
    }

    /// Adds `c·e` to a list of terms with distinct unit parts.
    fn accumulate(&mut self, list: &mut Vec<(f64, Expr)>, c: f64, e: Expr) {
        let (c, unit) = self.split_coefficient(c, e);
        match list.iter_mut().find(|t| t.1 == unit) {
            Some(t) => t.0 += c,
            None => list.push((c, unit)),
        }
    }

    /// Splits `c·e` into a coefficient and an expression without a coefficient.
    fn split_coefficient(&mut self, c: f64, e: Expr) -> (f64, Expr) {
        match self.node(e) {
            Node::Number(x) => {
                let x = *x;
                (c * x, self.number(1.0))
            }
            Node::Product(x, factors) if *x != 1.0 => {
                let (x, factors) = (*x, factors.clone());
                (c * x, self.product(1.0, &factors))
            }
            _ => (c, e),
        }
    }

    /// Replaces nested sums by their terms if one of these terms cancels exactly against a term
    /// elsewhere.
    fn open_cancelling_sums(&mut self, list: &mut Vec<(f64, Expr)>) {
        loop {
            let mut leaves: HashMap<Expr, f64> = HashMap::new();
            for &(c, e) in list.iter() {
                self.collect_leaves(c, e, &mut leaves);
            }
            let cancels = |g: &Self, e: Expr| {
                let mut inner = HashMap::new();
                g.collect_leaves(1.0, e, &mut inner);
                inner.keys().any(|leaf| leaves.get(leaf) == Some(&0.0))
            };
            let Some(at) = list
                .iter()
                .position(|t| matches!(self.node(t.1), Node::Sum(_)) && cancels(self, t.1))
            else {
                return;
            };
            let (c, e) = list.remove(at);
            let Node::Sum(terms) = self.node(e).clone() else {
                unreachable!("position() found a sum")
            };
            for (k, t) in terms {
                self.accumulate(list, c * k, t);
            }
        }
    }

    /// Collects the total coefficient of each term that is not a sum, through all nested sums.
    fn collect_leaves(&self, c: f64, e: Expr, leaves: &mut HashMap<Expr, f64>) {
        match self.node(e) {
            Node::Sum(terms) => {
                for &(k, t) in terms {
                    self.collect_leaves(c * k, t, leaves);
                }
            }
            Node::Product(k, f) if f.len() == 1 && f[0].1 == 1 => {
                self.collect_leaves(c * k, f[0].0, leaves);
            }
            _ => *leaves.entry(e).or_insert(0.0) += c,
        }
    }

    /// Returns powers that divide every term.
    fn common_factors(&self, list: &[(f64, Expr)]) -> Vec<(Expr, i32)> {
        let mut common = self.factors(list[0].1);
        for t in &list[1..] {
            let other = self.factors(t.1);
            common = common
                .into_iter()
                .filter_map(|(e, k)| {
                    let n = other.iter().find(|f| f.0 == e)?.1;
                    (n.signum() == k.signum()).then(|| (e, k.signum() * k.abs().min(n.abs())))
                })
                .collect();
        }
        common
    }

    fn factors(&self, e: Expr) -> Vec<(Expr, i32)> {
        match self.node(e) {
            Node::Number(_) => Vec::new(),
            Node::Product(_, factors) => factors.clone(),
            _ => vec![(e, 1)],
        }
    }

    fn intern(&mut self, node: Node) -> Expr {
        let key = match &node {
            Node::Number(x) => Key::Number(x.to_bits()),
            Node::Symbol(s) => Key::Symbol(*s),
            Node::Sum(terms) => Key::Sum(terms.iter().map(|(c, e)| (c.to_bits(), *e)).collect()),
            Node::Product(c, factors) => Key::Product(c.to_bits(), factors.clone()),
            Node::Call(f, u) => Key::Call(*f, *u),
        };
        if let Some(&e) = self.table.get(&key) {
            return e;
        }
        let e = Expr(self.nodes.len() as u32);
        self.nodes.push(node);
        self.table.insert(key, e);
        e
    }
}

/// Returns `xᵏ` by squaring. The result has the same bits on every machine, which `f64::powi` does
/// not guarantee.
fn power(x: f64, k: i32) -> f64 {
    let (mut result, mut square, mut rest) = (1.0, x, k.unsigned_abs());
    while rest > 0 {
        if rest % 2 == 1 {
            result *= square;
        }
        square *= square;
        rest /= 2;
    }
    if k < 0 { 1.0 / result } else { result }
}
