use std::collections::BTreeMap;
use std::ops::ControlFlow;
use pfaff::model::Registry;
use pfaff::dynamics::{MotionError, MotionOptions};
use pfaff::{Blueprint, Overrides, StudyError};
fn main() {
    let mut args = std::env::args().skip(1).map(|x| x.parse::<u64>().unwrap());
    let (seed, from, to) = (args.next().unwrap(), args.next().unwrap(), args.next().unwrap());
    let registry = Registry::planar();
    let mut tally: BTreeMap<String, (u64, u64)> = BTreeMap::new();
    for n in from..to {
        let text = fuzz::input::text(seed, n);
        let Ok(blueprint) = Blueprint::read("s", &text, &registry) else { continue };
        let mut again = Blueprint::read("s", &text, &registry).ok().unwrap();
        let started = std::time::Instant::now();
        let kind = match blueprint.prepare(&Overrides::default()) {
            Ok(mut study) => {
                let o = study.options.get_or_insert_with(|| MotionOptions::to(0.05));
                o.t_end = o.t_end.min(0.05);
                let mut steps = 0;
                let count = std::sync::atomic::AtomicUsize::new(0);
                let run = match study.plan() {
                    Err(e) => format!("plan: {}", head(&e.to_string())),
                    Ok(plan) => match plan.simulate_watched(&|_| if count.fetch_add(1, std::sync::atomic::Ordering::Relaxed) < 40 && started.elapsed().as_secs() < 2 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }, |_| { steps += 1; Ok(if steps > 20 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }) }) {
                        Ok(_) => "ran".to_owned(),
                        Err(f) => format!("stop{} {:?}", if f.summary.steps == 0 { "0" } else { "" }, short(&f.error)),
                    },
                };
                let ok = again.inquire(None).is_ok();
                format!("start, analyze {ok}, {run}")
            }
            Err(e) => {
                let k = match &e { StudyError::Scene(p) => head(&p[0].message), other => head(&format!("{other:?}")) };
                let fits = e.only_motion().is_some();
                let i = again.inquire(None);
                let i = match i { Ok(_) => "judged".to_owned(), Err(StudyError::Scene(p)) => head(&p[0].message), Err(o) => head(&o.to_string()) };
                format!("none (only motion {fits}): {k} | inquire: {i}")
            }
        };
        let e = tally.entry(kind).or_insert((0, n));
        e.0 += 1;
        if started.elapsed().as_millis() > 1500 { println!("slow {n} {:?}", started.elapsed()); }
    }
    for (k, (c, n)) in &tally { println!("{c:6} {n:7} {k}"); }
}
fn short(e: &MotionError) -> String { head(&format!("{e:?}")) }
fn head(s: &str) -> String { s.chars().filter(|c| !c.is_ascii_digit()).take(46).collect() }
