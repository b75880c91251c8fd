//! The faults that a run reports itself: warnings of the engine, energy growth, errors of programs, and the observations of
//! [`labspec_monitors::watch`].

use crate::run::Session;
use labspec_core::{Model, Warning, WarningStat, joint};
use labspec_monitors::stress::{
    Fault, FaultEvidence, FaultKind, geom_name, joint_of_dof, joint_of_place, stiffness_cause, unknown_cause,
};
use labspec_monitors::watch::Observations;

/// Warnings of numbers that are not finite or too large.
pub(super) const DIVERGED: [Warning; 3] = [Warning::BadQpos, Warning::BadQvel, Warning::BadQacc];

/// A warning that the engine gave in this run.
pub(super) fn warned(session: &Session<'_>, warning: Warning) -> Option<WarningStat> {
    session.warnings.get(warning as usize).copied().filter(|stat| stat.number > 0)
}

/// Warnings of the engine, energy growth, and errors of programs.
pub(super) fn reported_faults(session: &Session<'_>) -> Vec<Fault> {
    let m = &session.world.model;
    let mut list = Vec::new();
    list.extend(breakdown(session));
    list.extend(other_warnings(session, m));
    list.extend(session.program_errors.iter().map(|t| Fault {
        kind: FaultKind::Throws,
        time: t.time,
        subject: "a program of the lab".into(),
        cause: t.message.clone(),
        evidence: Vec::new(),
        size: 1.0,
        by_run: true,
    }));
    list
}

/// The breakdown of a run: energy growth or a bad number, whichever came first.
fn breakdown(session: &Session<'_>) -> Option<Fault> {
    let m = &session.world.model;
    let growth = session.growth();
    let first = DIVERGED.into_iter().filter_map(|w| Some((w, warned(session, w)?)));
    let first = first.min_by(|a, b| a.1.first_time.total_cmp(&b.1.first_time));
    let step = FaultEvidence { name: "timestep", value: m.opt.timestep, unit: "s" };
    let cause = || stiffness_cause(m).unwrap_or_else(|| unknown_cause(m));
    if let Some(g) = growth.filter(|g| first.is_none_or(|(_, stat)| g.time < stat.first_time)) {
        let diverged = first.map(|(_, stat)| FaultEvidence {
            name: "first NaN or huge value at",
            value: stat.first_time,
            unit: "s",
        });
        let mut evidence = vec![
            FaultEvidence { name: "energy gained", value: g.gain, unit: "J" },
            FaultEvidence { name: "energy at the start", value: g.available_energy, unit: "J" },
            step,
        ];
        evidence.extend(diverged);
        return Some(Fault {
            kind: FaultKind::Grows,
            time: g.time,
            subject: joint_of_dof(m, g.dof),
            cause: cause(),
            evidence,
            size: g.gain,
            by_run: true,
        });
    }
    let (warning, stat) = first?;
    let subject = match warning {
        Warning::BadQpos => joint_of_place(m, stat.lastinfo),
        _ => joint_of_dof(m, stat.lastinfo),
    };
    let evidence = vec![step, FaultEvidence { name: "larger than", value: 1e10, unit: "" }];
    Some(Fault {
        kind: FaultKind::Diverges,
        time: stat.first_time,
        subject,
        cause: cause(),
        evidence,
        size: 1.0,
        by_run: true,
    })
}

/// Warnings of the engine that do not end the run.
fn other_warnings(session: &Session<'_>, m: &Model) -> Vec<Fault> {
    let mut list = Vec::new();
    for warning in [Warning::Inertia, Warning::BadCtrl, Warning::ContactFull, Warning::ConstraintFull] {
        let Some(stat) = warned(session, warning) else { continue };
        let (subject, cause) = match warning {
            Warning::Inertia => (joint_of_dof(m, stat.lastinfo), "the moving part has no positive inertia"),
            Warning::BadCtrl => (
                format!("control {}", stat.lastinfo),
                "a program writes a control that is not a number or exceeds 1e10",
            ),
            _ => ("the whole scene".into(), "more bodies touch than the engine keeps contacts"),
        };
        // The same rule as in `run` and `check` (`run/diagnose.rs`).
        let kind = if warning == Warning::BadCtrl { FaultKind::Diverges } else { FaultKind::Warns };
        list.push(Fault {
            kind,
            time: stat.first_time,
            subject,
            cause: cause.into(),
            evidence: vec![FaultEvidence { name: "warnings", value: stat.number as f64, unit: "" }],
            size: 1.0,
            by_run: true,
        });
    }
    list
}

/// The earliest observation besides energy growth; later ones may be consequences of it.
pub(super) fn earliest_observed_fault(m: &Model, noticed: &Observations) -> Option<Fault> {
    let fault = |kind, time, subject: String, cause: &str, size, evidence| Fault {
        kind,
        time,
        subject,
        cause: cause.into(),
        evidence,
        size,
        by_run: true,
    };
    let number = |name, value, unit| FaultEvidence { name, value, unit };
    let both = |geoms: [usize; 2]| geoms.map(|g| geom_name(m, g));
    let past = noticed.past.map(|p| {
        let unit = if m.jnt_type.get(p.joint) == Some(&joint::SLIDE) { "m" } else { "rad" };
        let cause = match p.step {
            Some(_) => "one step takes it past its limit before the limit can push",
            None => "a motor or load is stronger than its limit",
        };
        let mut evidence = vec![number("beyond", p.beyond, unit), number("range", p.range, unit)];
        evidence.extend(p.step.map(|step| number("distance in one step", step, unit)));
        let subject = joint_of_dof(m, m.jnt_dofadr.get(p.joint).map_or(0, |&dof| dof as usize));
        fault(FaultKind::PastLimit, p.time, subject, cause, p.beyond / p.range, evidence)
    });
    let through = noticed.through.map(|t| {
        let [mover, wall] = both(t.geoms);
        let evidence = vec![
            number("distance in one step", t.moved, "m"),
            number("thickness of what it passes", t.thickness, "m"),
        ];
        let cause = "no step finds the two in contact from the right side";
        let size = t.moved / t.thickness;
        fault(FaultKind::Tunnels, t.time, format!("{mover} through {wall}"), cause, size, evidence)
    });
    let unsolved = noticed.unsolved.map(|u| {
        let evidence = vec![
            number("iterations", u.iterations as f64, ""),
            number("missing part of the forces", u.part, ""),
        ];
        let cause = "the solver reaches its iteration limit before its forces converge";
        fault(FaultKind::Unsolved, u.time, joint_of_dof(m, u.dof), cause, u.part, evidence)
    });
    let sunk = noticed.sunk.map(|s| {
        let [a, b] = both(s.geoms);
        let evidence = vec![
            number("depth", s.depth, "m"),
            number("thickness of the thinner one", s.thickness, "m"),
            number("force", s.force, "N"),
        ];
        let cause = "the contact is too soft for the load";
        fault(FaultKind::Sinks, s.time, format!("{a} and {b}"), cause, s.depth / s.thickness, evidence)
    });
    [past, through, unsolved, sunk].into_iter().flatten().min_by(|a, b| a.time.total_cmp(&b.time))
}
