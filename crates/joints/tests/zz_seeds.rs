#[test] fn s(){ let mut bad=0; for seed in 0..12u64 { if let Err(e)=joints::conformance::check_all(seed.wrapping_mul(7919)+1){ bad+=1; println!("seed {seed} {e}"); } } println!("bad {bad}"); }
