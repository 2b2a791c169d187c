//! Tests of the mechanics that compute much themselves: references by dense matrices, products with K, balances of each step. So they are
//! optimized, and `mechanics` is not.

#[path = "support/random.rs"]
mod random;
mod stress;

mod verification {
    #[allow(dead_code, reason = "`mechanics` uses the rest")]
    mod common;
    #[allow(dead_code, reason = "`mechanics` uses the rest")]
    mod elastic;
    #[allow(dead_code, reason = "`mechanics` uses the rest")]
    mod evidence;

    mod bar_spectrum;
    mod flutter;
    mod free_block;
    mod modes;
    mod on_elastic_disk;
    mod ring_modes;
    mod ring_ritz;
    mod ring_rotation;
    mod ring_settlement;
    mod ring_statics;
    mod ring_tools;
    mod ritz;
    mod sliding_in_time;
    mod sliding_modes;
    mod sliding_scenes;
    mod sliding_sparse;
}
