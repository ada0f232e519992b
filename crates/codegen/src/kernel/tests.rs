//! Tests single kernels. A kernel contains first the inputs, then the shared parts with their
//! names, then the outputs.

use quote::quote;
use symbolic::Scalar;

use super::kernel;
use crate::Kind;
use crate::testing::{REVOLUTE, constraint, model};

#[test]
fn a_kernel_reads_what_it_uses_and_names_what_it_shares() {
    let (model, _, k) = constraint(REVOLUTE);
    let printed = kernel(&model, &k.gamma[..1], Scalar::Generic);
    let statements = &printed.statements;
    let expected = quote! {
        let cos_i = x[0].cos;
        let sin_i = x[0].sin;
        let omega_i = v[0].omega;
        let cos_j = x[1].cos;
        let sin_j = x[1].sin;
        let omega_j = v[1].omega;
        let s_i_x = T::from(self.s_i[0]);
        let s_i_y = T::from(self.s_i[1]);
        let s_j_x = T::from(self.s_j[0]);
        let s_j_y = T::from(self.s_j[1]);
        let arm_i_x = cos_i * s_i_x - sin_i * s_i_y;
        let arm_j_x = cos_j * s_j_x - sin_j * s_j_y;
    };
    assert_eq!(quote!(#(#statements)*).to_string(), expected.to_string());
    let output = &printed.outputs[0];
    let expected = quote!(omega_i * omega_i * arm_i_x - omega_j * omega_j * arm_j_x);
    assert_eq!(output.to_string(), expected.to_string());
}

#[test]
fn numbers_of_the_type_f64_are_read_as_they_are() {
    let mut m = model(Kind::Constraint, REVOLUTE).unwrap_or_else(|e| panic!("{e}"));
    let x = m.inputs.values("s_i")[0];
    let doubled = m.g.product(2.0, &[(x, 1)]);
    let printed = kernel(&m, &[doubled], Scalar::F64);
    assert_eq!(
        printed.statements[0].to_string(),
        quote!(let s_i_x = self.s_i[0];).to_string()
    );
    assert_eq!(
        printed.outputs[0].to_string(),
        quote!(2.0 * s_i_x).to_string()
    );
}

/// The operations are counted manually. A rotated point needs 4 products and 2 sums.
#[test]
fn operations_of_the_revolute() {
    let (model, _, k) = constraint(REVOLUTE);
    let count = |outputs: &[_]| kernel(&model, outputs, Scalar::Generic).counts.to_string();
    // Two points, and r_i + arm_i − r_j − arm_j twice.
    assert_eq!(count(&k.phi), "8 mul, 10 add");
    let varying: Vec<_> =
        k.c.iter()
            .filter(|e| !e.constant)
            .map(|e| e.value)
            .collect();
    assert_eq!(count(&varying), "8 mul, 4 add, 2 neg");
    // Two points, ω² twice, four products and two differences.
    assert_eq!(count(&k.gamma), "14 mul, 6 add");
    assert_eq!(count(&[]), "none");
}
