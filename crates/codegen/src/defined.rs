//! Values in space that are differentiated as a whole: rotated vectors and products of vectors.
//!
//! If R·s is differentiated entry by entry along a rotation, nine products are differentiated. The
//! derivative as a whole is R·(ω × s). The product u·w of directions of two bodies changes by (ω ×
//! u)·w. For this product, w is transformed to the frame of u once for all three rotations.
//! Therefore each such value is a symbol while derivatives are computed. The symbol has rules for
//! its derivative. Before code is printed, the symbol is replaced by its definition
//! ([`Defined::expand`]).
//!
//! In the plane there are no such values, because a rotation is given by only two values, cosine
//! and sine.
//!
//! With these rules ∂(C·a − Γ)/∂x of a hinge in space has 360 products. Without the rules, entry by
//! entry, it has 939 products.

use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

use symbolic::{Derivation, Expr, Graph, Symbol};

use crate::vector::{Components, Frame, Vector, cross, dot};

/// The definition of a symbol.
#[derive(Clone)]
enum Definition {
    /// Component `k` of R·c or Rᵀ·c of the body in a slot. The field `all` contains the three
    /// symbols.
    Rotated {
        slot: usize,
        to_ground: bool,
        c: Components,
        all: Components,
        k: usize,
    },
    /// The product of a vector with components c in one frame and another vector, evaluated in that
    /// frame.
    Dot {
        frame: Frame,
        c: Components,
        other: Vector,
    },
    /// The square of a vector.
    Square(Vector),
}

/// All symbols with a definition, and their definitions.
#[derive(Default)]
pub(crate) struct Definitions {
    /// R of the body in each slot, stored by rows.
    rot: Vec<[[Expr; 3]; 3]>,
    of: HashMap<Expr, Definition>,
    /// The number of symbols that exist so far.
    symbols: usize,
    rotated: HashMap<(usize, bool, Components), Components>,
    dots: HashMap<(Frame, Components, Components), Vec<(Vector, Expr)>>,
    expanded: HashMap<Expr, Expr>,
}

/// A handle of the definitions of one model.
#[derive(Clone, Default)]
pub(crate) struct Defined(Rc<RefCell<Definitions>>);

impl Defined {
    pub(crate) fn new(rot: Vec<[[Expr; 3]; 3]>) -> Self {
        let definitions = Definitions {
            rot,
            ..Definitions::default()
        };
        Self(Rc::new(RefCell::new(definitions)))
    }

    /// Returns `R·c` or `Rᵀ·c` of the body in a slot.
    pub(crate) fn rotated(
        &self,
        g: &mut Graph,
        slot: usize,
        to_ground: bool,
        c: &[Expr],
    ) -> Components {
        if c.iter().all(|&e| g.is_zero(e)) {
            return c.to_vec();
        }
        let key = (slot, to_ground, c.to_vec());
        if let Some(known) = self.0.borrow().rotated.get(&key) {
            return known.clone();
        }
        let all: Components = (0..3).map(|_| self.symbol(g)).collect();
        let mut definitions = self.0.borrow_mut();
        for (k, &symbol) in all.iter().enumerate() {
            let (c, all) = (c.to_vec(), all.clone());
            let definition = Definition::Rotated {
                slot,
                to_ground,
                c,
                all,
                k,
            };
            definitions.of.insert(symbol, definition);
            // The three symbols need not be consecutive.
        }
        definitions.rotated.insert(key, all.clone());
        all
    }

    /// Returns `a · b`.
    pub(crate) fn dot(&self, g: &mut Graph, a: &Vector, b: &Vector) -> Expr {
        if a == b && a.parts().count() > 1 {
            let symbol = self.symbol(g);
            let square = Definition::Square(a.clone());
            self.0.borrow_mut().of.insert(symbol, square);
            return symbol;
        }
        let (few, many) = if a.parts().count() <= b.parts().count() {
            (a, b)
        } else {
            (b, a)
        };
        self.by_parts(g, few, many)
    }

    /// Returns `a · b`: the sum of the products of each part of `a` with `b`, each in the frame of
    /// the part of `a`.
    fn by_parts(&self, g: &mut Graph, a: &Vector, b: &Vector) -> Expr {
        let terms: Vec<(f64, Expr)> = a
            .parts()
            .map(|(frame, c)| (1.0, self.part(g, frame, c, b)))
            .collect();
        g.sum(&terms)
    }

    fn part(&self, g: &mut Graph, frame: Frame, c: &[Expr], other: &Vector) -> Expr {
        let is_zero = |c: &[Expr]| c.iter().all(|&e| g.is_zero(e));
        if is_zero(c) || other.parts().all(|(_, c)| is_zero(c)) {
            return g.number(0.0);
        }
        let same_frame: Vec<_> = other.parts().collect();
        if let [(own, components)] = same_frame.as_slice()
            && *own == frame
        {
            return dot(g, c, components);
        }
        let key = (
            frame,
            c.to_vec(),
            other.components().collect::<Components>(),
        );
        if let Some(known) = self.0.borrow().dots.get(&key)
            && let Some((_, symbol)) = known.iter().find(|(vector, _)| vector == other)
        {
            return *symbol;
        }
        let symbol = self.symbol(g);
        let definition = Definition::Dot {
            frame,
            c: c.to_vec(),
            other: other.clone(),
        };
        let mut definitions = self.0.borrow_mut();
        definitions.of.insert(symbol, definition);
        let list = definitions.dots.entry(key).or_default();
        list.push((other.clone(), symbol));
        symbol
    }

    /// Creates a symbol with a name that cannot occur in the source text.
    fn symbol(&self, g: &mut Graph) -> Expr {
        let mut definitions = self.0.borrow_mut();
        definitions.symbols += 1;
        g.symbol(&format!("#{}", definitions.symbols))
    }

    fn definition(&self, e: Expr) -> Option<Definition> {
        self.0.borrow().of.get(&e).cloned()
    }

    /// Returns the symbols in an expression that have a definition.
    fn defined_in(&self, g: &Graph, e: Expr) -> Vec<Expr> {
        let definitions = self.0.borrow();
        if definitions.of.is_empty() {
            return Vec::new();
        }
        let symbols = g.inputs(e).into_iter().map(|s| g.symbol_expr(s));
        symbols.filter(|e| definitions.of.contains_key(e)).collect()
    }

    /// Returns the inputs on which an expression depends, including the inputs in the definitions
    /// of its symbols.
    pub(crate) fn inputs(&self, g: &Graph, e: Expr) -> Vec<Symbol> {
        let mut found = BTreeSet::new();
        let mut seen = BTreeSet::new();
        let mut rest = vec![e];
        while let Some(e) = rest.pop() {
            for symbol in g.inputs(e) {
                if !seen.insert(symbol) {
                    continue;
                }
                match self.definition(g.symbol_expr(symbol)) {
                    Some(definition) => rest.extend(self.parts_of(definition)),
                    None => {
                        found.insert(symbol);
                    }
                }
            }
        }
        found.into_iter().collect()
    }

    /// Returns all expressions in a definition.
    fn parts_of(&self, definition: Definition) -> Vec<Expr> {
        let definitions = self.0.borrow();
        let rotation = |slot: usize| definitions.rot[slot].into_iter().flatten();
        let of_vector = |v: &Vector| -> Vec<Expr> {
            let frames = v.parts().filter_map(|(frame, _)| match frame {
                Frame::Body(slot) => Some(slot),
                Frame::Ground => None,
            });
            frames.flat_map(rotation).chain(v.components()).collect()
        };
        match definition {
            Definition::Rotated { slot, c, .. } => rotation(slot).chain(c).collect(),
            Definition::Dot { frame, c, other } => {
                let own = of_vector(&Vector::new(frame, c));
                [own, of_vector(&other)].concat()
            }
            Definition::Square(v) => of_vector(&v),
        }
    }

    /// Returns `e` with every symbol replaced by its definition.
    pub(crate) fn expand(&self, g: &mut Graph, e: Expr) -> Expr {
        let symbols = self.defined_in(g, e);
        if symbols.is_empty() {
            return e;
        }
        let pairs: Vec<(Expr, Expr)> = symbols
            .into_iter()
            .map(|symbol| (symbol, self.value(g, symbol)))
            .collect();
        g.substitute(e, &pairs)
    }

    /// Returns the definition of a symbol. Other symbols in it are replaced by their definitions.
    fn value(&self, g: &mut Graph, symbol: Expr) -> Expr {
        if let Some(&known) = self.0.borrow().expanded.get(&symbol) {
            return known;
        }
        let value = match self.definition(symbol) {
            Some(Definition::Rotated {
                slot,
                to_ground,
                c,
                k,
                ..
            }) => {
                let rot = self.0.borrow().rot[slot];
                let row = if to_ground {
                    rot[k]
                } else {
                    rot.map(|row| row[k])
                };
                dot(g, &row, &c)
            }
            Some(Definition::Dot { frame, c, other }) => {
                let other = self.in_frame(g, frame, &other);
                dot(g, &c, &other)
            }
            Some(Definition::Square(v)) => {
                let v = self.in_frame(g, Frame::Ground, &v);
                dot(g, &v, &v)
            }
            None => symbol,
        };
        let value = self.expand(g, value);
        self.0.borrow_mut().expanded.insert(symbol, value);
        value
    }

    /// Returns the components of a vector in a frame.
    fn in_frame(&self, g: &mut Graph, frame: Frame, v: &Vector) -> Components {
        let zero = g.number(0.0);
        let mut own = vec![zero; 3];
        let mut ground: Vec<Components> = Vec::new();
        for (part, c) in v.parts() {
            match part {
                _ if part == frame => own = c.clone(),
                Frame::Ground => ground.push(c.clone()),
                Frame::Body(slot) => ground.push(self.rotated(g, slot, true, c)),
            }
        }
        let sum = |g: &mut Graph, k: usize| {
            let terms: Vec<(f64, Expr)> = ground.iter().map(|c| (1.0, c[k])).collect();
            g.sum(&terms)
        };
        let others: Components = (0..3).map(|k| sum(g, k)).collect();
        let others = match frame {
            Frame::Ground => others,
            Frame::Body(slot) => self.rotated(g, slot, false, &others),
        };
        (0..3).map(|k| g.add(own[k], others[k])).collect()
    }
}

/// A derivation with rules for vectors that rotate with their bodies.
#[derive(Clone)]
pub(crate) struct Along {
    plain: Derivation,
    /// The angular velocity of the body in each slot for this derivation, in the frame of the body.
    /// The list is empty in the plane.
    spins: Vec<Components>,
    defined: Defined,
    /// Whether products of two bodies are evaluated in the frame of the first body. If not, they
    /// are evaluated in the frame of the vector that changes. The result can then be used for all
    /// rotations of the body of this vector.
    ordered: bool,
    images: RefCell<HashMap<Expr, Expr>>,
}

impl Along {
    /// Creates the derivation with these images of inputs and these angular velocities of slots.
    pub(crate) fn new(
        g: &Graph,
        defined: &Defined,
        images: &[(Expr, Expr)],
        spins: Vec<Components>,
    ) -> Self {
        Self {
            plain: Derivation::new(g, images),
            spins,
            defined: defined.clone(),
            ordered: false,
            images: RefCell::default(),
        }
    }

    /// Returns the same derivation for derivatives with respect to time. In such derivatives, equal
    /// products of two bodies are computed only once.
    pub(crate) fn in_time(self) -> Self {
        Self {
            ordered: true,
            ..self
        }
    }

    /// Returns `D(e)`, the derivative of `e`.
    pub(crate) fn apply(&self, g: &mut Graph, e: Expr) -> Expr {
        let symbols = self.defined.defined_in(g, e);
        if symbols.is_empty() {
            return self.plain.apply(g, e);
        }
        let images: Vec<(Expr, Expr)> = symbols
            .into_iter()
            .map(|symbol| (symbol, self.image(g, symbol)))
            .collect();
        self.plain.with(g, &images).apply(g, e)
    }

    fn image(&self, g: &mut Graph, symbol: Expr) -> Expr {
        if let Some(&known) = self.images.borrow().get(&symbol) {
            return known;
        }
        let image = match self.defined.definition(symbol) {
            // R·c ↦ R·(ω × c + ċ), Rᵀ·c ↦ Rᵀ·ċ − ω × Rᵀ·c
            Some(Definition::Rotated {
                slot,
                to_ground,
                c,
                all,
                k,
            }) => {
                let rates: Components = c.iter().map(|&e| self.apply(g, e)).collect();
                if to_ground {
                    let rates = self.carried(g, Frame::Body(slot), &c, rates);
                    self.defined.rotated(g, slot, true, &rates)[k]
                } else {
                    let own = self.defined.rotated(g, slot, false, &rates)[k];
                    match self.spins.get(slot) {
                        Some(spin) => {
                            let turned = cross(g, spin, &all)[k];
                            g.sub(own, turned)
                        }
                        None => own,
                    }
                }
            }
            Some(Definition::Dot { frame, c, other }) => {
                let rates: Components = c.iter().map(|&e| self.apply(g, e)).collect();
                let rates = self.carried(g, frame, &c, rates);
                let first = self.product(g, frame, &rates, &other);
                let change = self.change(g, &other);
                let own = Vector::new(frame, c);
                let mut terms = vec![(1.0, first)];
                for (frame, rates) in change.parts() {
                    terms.push((1.0, self.product(g, frame, rates, &own)));
                }
                g.sum(&terms)
            }
            Some(Definition::Square(v)) => {
                let change = self.change(g, &v);
                let half = self.defined.by_parts(g, &change, &v);
                g.sum(&[(2.0, half)])
            }
            None => g.number(0.0),
        };
        self.images.borrow_mut().insert(symbol, image);
        image
    }

    fn product(&self, g: &mut Graph, frame: Frame, c: &[Expr], other: &Vector) -> Expr {
        let mut parts = other.parts();
        match (parts.next(), parts.next()) {
            (Some((first, own)), None) if self.ordered && first < frame => {
                let other = Vector::new(frame, c.to_vec());
                self.defined.part(g, first, own, &other)
            }
            _ => self.defined.part(g, frame, c, other),
        }
    }

    /// Returns the derivative of a vector, part by part.
    fn change(&self, g: &mut Graph, v: &Vector) -> Vector {
        let parts = v.parts().map(|(frame, c)| {
            let rates: Components = c.iter().map(|&e| self.apply(g, e)).collect();
            (frame, self.carried(g, frame, c, rates))
        });
        Vector::of_parts(parts.collect())
    }

    /// Returns `ċ + ω × c` in the frame of a body, and `ċ` in the frame of the ground.
    fn carried(&self, g: &mut Graph, frame: Frame, c: &[Expr], rates: Components) -> Components {
        match frame {
            Frame::Body(slot) if slot < self.spins.len() => {
                let turned = cross(g, &self.spins[slot], c);
                let pairs = rates.into_iter().zip(turned);
                pairs.map(|(rate, turned)| g.add(rate, turned)).collect()
            }
            _ => rates,
        }
    }
}
