//! Compares the structure of two recordings that may differ in their stored values.

use joints::recorded::{Operation, RecordedNumber};

use super::RecordedEquations;

/// The FNV-1a hash with 64 bits: G. Fowler, L. C. Noll, K.-P. Vo, The FNV Non-Cryptographic Hash
/// Algorithm.
struct Digest(u64);

impl Digest {
    const BASIS: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0100_0000_01b3;

    fn bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(Self::PRIME);
        }
    }

    fn take(&mut self, numbers: &[usize]) {
        for k in numbers {
            self.bytes(&(*k as u64).to_le_bytes());
        }
    }

    /// Adds a list with its length, so that consecutive lists are distinguishable.
    fn list(&mut self, values: &[RecordedNumber]) {
        self.take(&[values.len()]);
        values.iter().for_each(|r| self.take(&[r.place()]));
    }
}

impl RecordedEquations {
    /// Returns a digest of everything except the stored values. The digest covers operations,
    /// inputs, results, and the kinds of the functions of time. The digest is the same on every
    /// machine and in every build of one version.
    ///
    /// ```
    /// use pfaff_model::{Body, Description, Mechanism, RecordedEquations};
    /// let recorded = |bodies: &[Body]| {
    ///     let d = Description { bodies: bodies.to_vec(), ..Description::default() };
    ///     RecordedEquations::of(&Mechanism::build(&d).unwrap())
    /// };
    /// let [light, heavy] = [Body::new("light", 1.0, 0.1), Body::new("heavy", 5.0, 0.1)];
    /// let both = [recorded(&[light.clone()]), recorded(&[heavy.clone()])];
    /// assert_eq!(both[0].shape(), both[1].shape());
    /// let mass = both[0].beside.mass[0].place();
    /// assert_eq!(both.each_ref().map(|r| r.number(mass)), [Some(1.0), Some(5.0)]);
    /// assert_ne!(both[0].shape(), recorded(&[light, heavy]).shape());
    /// ```
    #[must_use]
    pub fn shape(&self) -> u64 {
        let mut d = Digest(Digest::BASIS);
        d.take(&[self.tape.len(), self.beside.first]);
        for operation in &self.tape {
            match *operation {
                Operation::Number(_) => d.take(&[0]),
                Operation::Input(k) => d.take(&[1, k]),
                Operation::Add(a, b) => d.take(&[2, a.place(), b.place()]),
                Operation::Sub(a, b) => d.take(&[3, a.place(), b.place()]),
                Operation::Mul(a, b) => d.take(&[4, a.place(), b.place()]),
                Operation::Div(a, b) => d.take(&[5, a.place(), b.place()]),
                Operation::Neg(a) => d.take(&[6, a.place()]),
                Operation::Sqrt(a) => d.take(&[7, a.place()]),
                Operation::RecipOrZero(a) => d.take(&[8, a.place()]),
                Operation::AngleOverSine(a, order) => d.take(&[9, a.place(), order.into()]),
            }
        }
        for input in &self.inputs {
            d.bytes(format!("{input:?}").as_bytes());
        }
        for list in [&self.phi, &self.b, &self.gamma, &self.force, &self.rate] {
            d.list(list);
        }
        for list in [&self.weight, &self.beside.mass] {
            d.list(list);
        }
        for row in &self.c {
            d.take(&[row.len()]);
            row.iter()
                .for_each(|(column, r)| d.take(&[*column, r.place()]));
        }
        for axes in &self.beside.principal {
            d.list(axes.as_ref().map_or(&[], |axes| axes.as_slice()));
        }
        for (numbers, (form, kind)) in self.beside.functions.iter().zip(&self.kinds) {
            d.list(numbers);
            d.bytes(format!("{form:?} {kind}").as_bytes());
        }
        d.0
    }
}
