//! Cost of the deviation from the reference acceleration, and the force, which is minus the gradient of the cost.
//!
//! Let x = J a - aref for the rows of a constraint, and D = 1/R (MuJoCo's documentation, "Computation: Constraint
//! model"). The cost of an equality is ½ D x². That of dry friction is the same up to the largest force, and linear
//! beyond it (Huber 1964). A unilateral row (limit or contact normal) has a cost only for x < 0. A contact with an
//! elliptic cone has three zones: zero cost if the contact separates, the full ½ D x² if it sticks, and the squared
//! distance from the dual cone if it slides.

use super::kind;
use crate::math::MINVAL;
use crate::model::Contact;

/// The type of a cost function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cost {
    /// Acts in both directions, without a limit.
    Quadratic,
    /// Acts in both directions, up to a largest force.
    DryFriction,
    /// Acts in one direction.
    Unilateral,
    /// Normal and friction of an elliptic cone together.
    Cone,
}

/// Values of `efc_state` (mjtConstraintState).
pub(super) mod state {
    pub(in crate::constraint) const SATISFIED: i32 = 0;
    pub(in crate::constraint) const QUADRATIC: i32 = 1;
    pub(in crate::constraint) const LINEARNEG: i32 = 2;
    pub(in crate::constraint) const LINEARPOS: i32 = 3;
    pub(in crate::constraint) const CONE: i32 = 4;
}

impl Cost {
    /// The cost function of a row with the given `efc_type`.
    pub(super) fn for_row(kind: i32) -> Cost {
        match kind {
            kind::EQUALITY => Cost::Quadratic,
            kind::FRICTION_DOF | kind::FRICTION_TENDON => Cost::DryFriction,
            kind::CONTACT_ELLIPTIC => Cost::Cone,
            _ => Cost::Unilateral,
        }
    }
}

/// x if a unilateral row pushes, zero otherwise.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn clamp_unilateral(x: f64) -> f64 {
    if x < 0.0 { x } else { 0.0 }
}

/// The second derivative of the cost of a unilateral row.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn unilateral_curvature(x: f64, stiff: f64) -> f64 {
    if x < 0.0 { stiff } else { 0.0 }
}

/// The change of the cost of a unilateral row from x to x + α v, and its first and second derivative along v at x + α
/// v.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn unilateral_along(x: f64, v: f64, alpha: f64, stiff: f64) -> [f64; 3] {
    let current = x + alpha * v;
    let (before, after) = (x.min(0.0), current.min(0.0));
    // The difference of squares is factored: near the minimum, subtracting squares would leave only rounding errors.
    let change = if before < 0.0 && after < 0.0 { alpha * v } else { after - before };
    let cost = 0.5 * stiff * change * (after + before);
    if current < 0.0 { [cost, stiff * current * v, stiff * v * v] } else { [cost, 0.0, 0.0] }
}

/// The parameters of the cost of one constraint.
#[derive(Clone, Copy)]
pub(super) struct CostParameters<'a, const R: usize> {
    pub(super) cost: Cost,
    /// 1/R of each row.
    pub(super) stiff: &'a [f64; R],
    /// Largest force of dry friction, N or N m.
    pub(super) loss: f64,
    /// The contact, for a cone.
    pub(super) contact: Option<&'a Contact>,
}

/// Second derivative of a cost: zero, a diagonal matrix, or a full matrix.
pub(super) enum Curvature<const R: usize> {
    Flat,
    Diagonal([f64; R]),
    Full([[f64; R]; R]),
}

/// The region of x, which determines the form of the cost.
enum Zone<const R: usize> {
    /// Zero: the contact of a cone separates.
    Satisfied,
    /// Quadratic in all rows.
    Quadratic,
    /// Quadratic in the rows that are negative.
    Unilateral,
    /// Linear: dry friction at its largest force. The sign is that of x.
    Linear(f64),
    /// Proportional to the squared distance from the cone: a sliding contact.
    Cone(SlidingCone<R>),
}

/// A sliding contact, in the coordinates in which its cone is circular: N = μ x₀, U = f x along the friction
/// directions.
struct SlidingCone<const R: usize> {
    mu: f64,
    /// Scale of each row.
    scale: [f64; R],
    /// N, then U.
    u: [f64; R],
    /// |U|
    t: f64,
    /// D₀ / (μ² (1 + μ²))
    stiff: f64,
}

impl<const R: usize> SlidingCone<R> {
    /// N - μ |U|, negative: minus the distance from the cone, up to a constant factor.
    fn depth(&self) -> f64 {
        self.u[0] - self.mu * self.t
    }
}

impl<const R: usize> CostParameters<'_, R> {
    /// Cost and force at x.
    #[inline]
    pub(super) fn value(&self, x: &[f64; R]) -> (f64, [f64; R]) {
        self.value_in(&self.zone(x), x)
    }

    /// Cost and force at x in a known zone.
    #[inline]
    fn value_in(&self, zone: &Zone<R>, x: &[f64; R]) -> (f64, [f64; R]) {
        let mut force = [0.0; R];
        match zone {
            Zone::Satisfied => (0.0, force),
            Zone::Quadratic => self.quadratic(x),
            Zone::Unilateral => self.quadratic(&x.map(clamp_unilateral)),
            Zone::Linear(side) => {
                force[0] = -side * self.loss;
                (self.loss * (side * x[0] - 0.5 * self.loss / self.stiff[0]), force)
            }
            Zone::Cone(s) => {
                let depth = s.depth();
                let normal = -s.stiff * depth * s.mu;
                force = std::array::from_fn(|j| -normal / s.t * s.u[j] * s.scale[j]);
                force[0] = normal;
                (0.5 * s.stiff * depth * depth, force)
            }
        }
    }

    fn quadratic(&self, x: &[f64; R]) -> (f64, [f64; R]) {
        let force: [f64; R] = std::array::from_fn(|r| -self.stiff[r] * x[r]);
        let mut cost = force[0] * x[0];
        for r in 1..R {
            cost += force[r] * x[r];
        }
        (-0.5 * cost, force)
    }

    #[inline]
    fn zone(&self, x: &[f64; R]) -> Zone<R> {
        match self.cost {
            Cost::Quadratic => Zone::Quadratic,
            Cost::Unilateral => Zone::Unilateral,
            Cost::DryFriction if x[0].abs() >= self.loss / self.stiff[0] => {
                Zone::Linear(if x[0] < 0.0 { -1.0 } else { 1.0 })
            }
            Cost::DryFriction => Zone::Quadratic,
            Cost::Cone => self.zone_of_cone(x),
        }
    }

    /// The zone of a cone. A block without a contact counts as separated.
    #[inline]
    fn zone_of_cone(&self, x: &[f64; R]) -> Zone<R> {
        // A cone has one normal and two, three or five friction directions. This condition removes the code for other
        // numbers of rows.
        let Some(c) = self.contact.filter(|_| (3..=6).contains(&R)) else { return Zone::Satisfied };
        let mu = c.mu;
        let scale: [f64; R] = std::array::from_fn(|j| if j == 0 { mu } else { c.friction[(j - 1).min(4)] });
        let u: [f64; R] = std::array::from_fn(|j| scale[j] * x[j]);
        let mut square = 0.0;
        for u in &u[1..] {
            square += u * u;
        }
        let (n, t) = (u[0], square.sqrt());
        if n >= mu * t || t <= 0.0 && n >= 0.0 {
            Zone::Satisfied
        } else if mu * n + t <= 0.0 || t <= 0.0 && n < 0.0 {
            Zone::Quadratic
        } else {
            let stiff = self.stiff[0] / (mu * mu * (1.0 + mu * mu)).max(MINVAL);
            Zone::Cone(SlidingCone { mu, scale, u, t, stiff })
        }
    }

    /// Second derivative at x.
    #[inline]
    pub(super) fn curvature(&self, x: &[f64; R]) -> Curvature<R> {
        self.curvature_in(&self.zone(x), x)
    }

    #[inline]
    fn curvature_in(&self, zone: &Zone<R>, x: &[f64; R]) -> Curvature<R> {
        match zone {
            Zone::Satisfied | Zone::Linear(_) => Curvature::Flat,
            Zone::Quadratic => Curvature::Diagonal(*self.stiff),
            Zone::Unilateral if x.iter().all(|&x| x >= 0.0) => Curvature::Flat,
            Zone::Unilateral => {
                Curvature::Diagonal(std::array::from_fn(|r| unilateral_curvature(x[r], self.stiff[r])))
            }
            Zone::Cone(s) => Curvature::Full(s.curvature()),
        }
    }

    /// The change of the cost from x to x + α v, and its first and second derivative along v at x + α v. If both ends
    /// are in the same zone, the difference is computed without the two costs: near the minimum, subtracting them
    /// would leave only rounding errors.
    #[inline]
    pub(super) fn along(&self, x: &[f64; R], v: &[f64; R], alpha: f64) -> [f64; 3] {
        let current: [f64; R] = std::array::from_fn(|r| x[r] + alpha * v[r]);
        let (before, after) = (self.zone(x), self.zone(&current));
        let (cost, force) = self.value_in(&after, &current);
        let mut slope = 0.0;
        for r in 0..R {
            slope -= force[r] * v[r];
        }
        let change = match (&before, &after) {
            (Zone::Satisfied, Zone::Satisfied) => 0.0,
            (Zone::Quadratic, Zone::Quadratic) => {
                (0..R).map(|r| 0.5 * self.stiff[r] * alpha * v[r] * (x[r] + current[r])).sum()
            }
            (Zone::Unilateral, Zone::Unilateral) => {
                (0..R).map(|r| unilateral_along(x[r], v[r], alpha, self.stiff[r])[0]).sum()
            }
            (Zone::Linear(a), Zone::Linear(b)) if a == b => a * self.loss * alpha * v[0],
            (Zone::Cone(a), Zone::Cone(b)) => {
                let squares: f64 = (1..R).map(|j| a.scale[j] * alpha * v[j] * (a.u[j] + b.u[j])).sum();
                let change = a.mu * alpha * v[0] - a.mu * squares / (a.t + b.t);
                0.5 * a.stiff * change * (a.depth() + b.depth())
            }
            _ => cost - self.value_in(&before, x).0,
        };
        [change, slope, self.curvature_in(&after, &current).along(v)]
    }

    /// Whether the cost is a single quadratic function from x to x + v.
    #[inline]
    pub(super) fn is_quadratic_along(&self, x: &[f64; R], v: &[f64; R]) -> bool {
        let current: [f64; R] = std::array::from_fn(|r| x[r] + v[r]);
        match (self.zone(x), self.zone(&current)) {
            (Zone::Satisfied, Zone::Satisfied) | (Zone::Quadratic, Zone::Quadratic) => true,
            (Zone::Unilateral, Zone::Unilateral) => (0..R).all(|r| (x[r] < 0.0) == (current[r] < 0.0)),
            (Zone::Linear(a), Zone::Linear(b)) => a == b,
            _ => false,
        }
    }

    /// `efc_state` of each row at x.
    pub(super) fn state(&self, x: &[f64; R]) -> [i32; R] {
        match self.zone(x) {
            Zone::Satisfied => [state::SATISFIED; R],
            Zone::Quadratic => [state::QUADRATIC; R],
            Zone::Unilateral => x.map(|x| if x < 0.0 { state::QUADRATIC } else { state::SATISFIED }),
            Zone::Linear(side) if side < 0.0 => [state::LINEARNEG; R],
            Zone::Linear(_) => [state::LINEARPOS; R],
            Zone::Cone(_) => [state::CONE; R],
        }
    }
}

impl<const R: usize> SlidingCone<R> {
    fn curvature(&self) -> [[f64; R]; R] {
        let SlidingCone { mu, scale, u, t, stiff } = self;
        let (n, t2) = (u[0], t * t);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let round = match (i, j) {
                    (0, 0) => 1.0,
                    (0, k) | (k, 0) => -mu * u[k] / t,
                    _ => {
                        let same = if i == j { mu * mu - mu * n / t } else { 0.0 };
                        mu * n / (t2 * t) * u[i] * u[j] + same
                    }
                };
                stiff * round * scale[i] * scale[j]
            })
        })
    }
}

impl<const R: usize> Curvature<R> {
    /// vᵀ C v
    fn along(&self, v: &[f64; R]) -> f64 {
        match self {
            Curvature::Flat => 0.0,
            Curvature::Diagonal(w) => (0..R).map(|r| w[r] * v[r] * v[r]).sum(),
            Curvature::Full(c) => (0..R).map(|i| v[i] * (0..R).map(|j| c[i][j] * v[j]).sum::<f64>()).sum(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(a: f64, b: f64, scale: f64) -> bool {
        (a - b).abs() <= 1e-5 * (1.0 + scale)
    }

    proptest! {
        /// The force is minus the gradient, the curvature is its derivative, and the change along a line is
        /// consistent, in all zones.
        #[test]
        fn derivatives(
            x in prop::array::uniform6(-2.0f64..2.0),
            v in prop::array::uniform6(-1.0f64..1.0),
            friction in prop::array::uniform5(0.1f64..2.0),
            impratio in 0.3f64..5.0,
            loss in 0.1f64..3.0,
            which in 0usize..4,
        ) {
            let d0 = 1.7;
            let mu = friction[0] / impratio.sqrt();
            let contact = Contact { mu, friction, ..Contact::default() };
            let mut stiff = [d0; 6];
            for j in 1..6 {
                stiff[j] = d0 * (friction[j - 1] / mu).powi(2);
            }
            let cost = [Cost::Quadratic, Cost::Unilateral, Cost::DryFriction, Cost::Cone][which];
            if which == 2 {
                let shape = CostParameters { cost, stiff: &[d0], loss, contact: None };
                check_shape(&shape, &[x[0]], &[v[0]])?;
            } else {
                check_shape(&CostParameters { cost, stiff: &stiff, loss, contact: Some(&contact) }, &x, &v)?;
            }
        }
    }

    fn check_shape<const R: usize>(
        s: &CostParameters<R>,
        x: &[f64; R],
        v: &[f64; R],
    ) -> Result<(), TestCaseError> {
        let point_at = |alpha: f64| -> [f64; R] { std::array::from_fn(|r| x[r] + alpha * v[r]) };
        let h = 1e-6;
        let (ahead, behind) = (s.value(&point_at(h)), s.value(&point_at(-h)));
        let [change, slope, curvature] = s.along(x, v, 0.7);
        let (there, here) = (s.value(&point_at(0.7)).0, s.value(x).0);
        prop_assert!(
            (change - (there - here)).abs() < 1e-12 * (1.0 + there + here),
            "{change}, {}",
            there - here
        );
        let [zero, start, _] = s.along(x, v, 0.0);
        prop_assert_eq!(zero, 0.0);
        prop_assert!(close(start, (ahead.0 - behind.0) / (2.0 * h), here));
        let along = |f: [f64; R]| -(0..R).map(|r| f[r] * v[r]).sum::<f64>();
        let (next, last) = (s.value(&point_at(0.7 + h)).1, s.value(&point_at(0.7 - h)).1);
        prop_assert!(close(slope, along(s.value(&point_at(0.7)).1), there));
        // There may be a kink of the force between the two points.
        if s.state(&point_at(0.7 + h)) == s.state(&point_at(0.7 - h)) {
            let numeric = (along(next) - along(last)) / (2.0 * h);
            prop_assert!(
                (curvature - numeric).abs() < 1e-3 * (1.0 + curvature.abs()),
                "{curvature}, {numeric}"
            );
        }
        Ok(())
    }
}
