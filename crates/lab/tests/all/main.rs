//! Every comparator against known motions and against the product.

mod formulations;
mod known;
mod methods;
mod solvers;
mod work_precision;
