//! Whether a slider affects a simulation.

use super::bound::BoundVerify;
use super::run_cache::BoundLab;
use crate::run::{Budget, Session, Start};
use crate::source::Text;
use labspec_core::reflect::{FieldId, Object, option};
use labspec_core::{self as core, AccessSet, Plan};
use labspec_expr::Value;

/// Whether a control affects any computed value of the simulation, at its start or in its first steps. Colours and views do
/// not count.
pub(super) fn slider_changes_anything(bound: &BoundVerify<'_>, label: &Text, from: f64, to: f64) -> bool {
    const STEPS: usize = 20;
    let Some(BoundLab { lab, model, programs, .. }) = bound.lab() else { return false };
    let start = |x: f64| {
        let plan = Some(Plan::new(model, &AccessSet::ANY));
        let start = Start { key: lab.keyframe(), plan, budget: Budget::TRIAL };
        let mut session = Session::start(programs.clone(), model, start);
        let (i, _) = programs.control(&label.value)?;
        session.set_control(i, Value::Number(x));
        Some(session)
    };
    let (Some(mut a), Some(mut b)) = (start(from), start(to)) else { return false };
    let variables = programs.effects_of(&label.value).is_some_and(|e| !e.ctx_writes.is_empty() || e.any_ctx);
    let differs = |a: &Session<'_>, b: &Session<'_>, f: FieldId| {
        let count = core::length(&a.world.model, &a.world.data, f);
        let other = core::length(&b.world.model, &b.world.data, f);
        let bits = |s: &Session<'_>, i| core::element(&s.world.model, &s.world.data, f, i).map(f64::to_bits);
        count != other || (0..count).any(|i| bits(a, i) != bits(b, i))
    };
    let computed = |f: &FieldId| f.info().object == Object::Data || *f == option::timestep;
    let any = |a: &Session<'_>, b: &Session<'_>| {
        (0..).map_while(FieldId::new).filter(computed).any(|f| differs(a, b, f))
    };
    if variables || any(&a, &b) {
        return true;
    }
    for _ in 0..STEPS {
        a.step();
        b.step();
    }
    any(&a, &b)
}
