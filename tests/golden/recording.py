"""What the recorders of this folder share: numbers as text, states, the fields of a model, forward passes and
trajectories of MuJoCo 3.14.0.

Numbers are written as text, shortest form that reads back to the same bits, because not every JSON reader
keeps the last bit. Arrays are flat, row-major; `0*12` is twelve zeros.
"""
import json

import mujoco
import numpy as np

# Warnings are recorded; they need no log file and no screen.
mujoco.set_mju_user_warning(lambda text: None)

INTEGRATORS = ("Euler", "RK4", "implicit", "implicitfast", "discrete")

# What of a model is not ours to compute: search trees, elastic bodies, skins, plugins, name tables, pixels, patterns and
# sizes of the library's own memory.
OTHERS = ("B_ actuator_plugin body_bvh body_plugin bvh_ dof_Madr efm0_ flex flg_ geom_plugin hfield_pathadr map mesh_bvh "
          "mesh_extrema mesh_oct mesh_pathadr mesh_poly nB nJf nM name narena nbuffer nbvh nconmax nefm nemax nflex njmax "
          "nmeshdegmax nmeshpoly nnames noct npaths nplugin npolygonmax nskin ntexdata ntextdata oct_ path plugin sensor_plugin "
          "signature skin_ tex_ text_").split()
# Kinds of named objects.
NAMED = ("body joint geom site camera light mesh hfield texture material pair exclude equality tendon actuator sensor numeric text "
         "tuple key").split()

# Everything that a forward pass without constraints computes.
FIELDS = ("xpos xquat xmat xipos ximat xanchor xaxis geom_xpos geom_xmat site_xpos site_xmat cam_xpos cam_xmat light_xpos "
          "light_xdir subtree_com cdof cinert ten_length ten_J ten_wrapadr ten_wrapnum wrap_obj wrap_xpos actuator_length "
          "moment_rownnz moment_rowadr moment_colind actuator_moment crb M qLD qLDiagInv ten_velocity actuator_velocity cvel cdof_dot qfrc_bias qfrc_spring qfrc_damper qfrc_gravcomp qfrc_fluid "
          "qfrc_passive actuator_force qfrc_actuator act_dot qfrc_smooth qacc_smooth qfrc_constraint qacc sensordata energy").split()
# What is recorded along a trajectory: the state, and what was computed on the way to it.
ROW = "qpos qvel act sensordata energy".split()
# What is computed on request.
POST = "subtree_linvel subtree_angmom cacc cfrc_int cfrc_ext qfrc_inverse".split()
# What a state is, and what acts on it.
STATE = "time qpos qvel act ctrl qfrc_applied xfrc_applied mocap_pos mocap_quat".split()


def runs(values):
    """Run lengths [value, repeats]."""
    out = []
    for v in values:
        if out and out[-1][0] == v:
            out[-1][1] += 1
        else:
            out.append([v, 1])
    return out


def word(x):
    """The shortest text of a number: of its own precision, an integer without its point."""
    return str(x.item() if x.dtype != np.float32 else x).removesuffix(".0")


def text(a):
    """Numbers as text, equal neighbours as `0*12`."""
    a = np.asarray(a)
    flat = (a if a.dtype == np.float32 else a.astype(float)).ravel()
    return " ".join(w if n == 1 else f"{w}*{n}" for w, n in runs(word(x) for x in flat))


def start(m, d):
    """The first keyframe, or the default configuration."""
    mujoco.mj_resetDataKeyframe(m, d, 0) if m.nkey else mujoco.mj_resetData(m, d)


def constants(m):
    """Every constant that an engine without drawings needs: {"model": .., "opt": .., "stat": .., "single": ..}, the last
    for what the library keeps in single precision."""
    out = {"model": {}, "single": {}}
    for part, owner in (("model", m), ("opt", m.opt), ("stat", m.stat)):
        values = out.setdefault(part, {})
        for name in dir(owner):
            value = getattr(owner, name)
            if name.startswith(("_", *OTHERS)) or not isinstance(value, (int, float, np.ndarray)) or not np.size(value):
                continue
            (out["single"] if getattr(value, "dtype", None) == np.float32 else values)[name] = text(value)
    return out


def names(m):
    """Names of all objects, in the order of their ids."""
    out = {}
    for kind in NAMED:
        code = mujoco.mju_str2Type(kind)
        count = getattr(m, {"joint": "njnt", "camera": "ncam", "texture": "ntex", "material": "nmat", "equality": "neq",
                            "actuator": "nactuator"}.get(kind, "n" + kind))
        if count:
            out[kind] = [mujoco.mj_id2name(m, code, i) or "" for i in range(count)]
    return out


def scatter(m, d, rng, scale):
    """A random state near the present one, with random controls, some of them beyond their range."""
    mujoco.mj_integratePos(m, d.qpos, rng.normal(size=m.nv) * scale, 1.0)
    d.qvel[:] = rng.normal(size=m.nv)
    d.act[:] = rng.uniform(0, 1, size=m.na)
    limited = m.actuator_ctrllimited.astype(bool) if m.nu == m.nactuator else np.zeros(m.nu, bool)
    low, high = m.actuator_ctrlrange.T if limited.any() else (np.zeros(m.nu), np.zeros(m.nu))
    middle, half = np.where(limited, (low + high) / 2, 0.0), np.where(limited, (high - low) / 2, 1.0)
    d.ctrl[:] = middle + half * rng.uniform(-1.2, 1.2, size=m.nu)
    d.mocap_pos[:] += rng.normal(size=(m.nmocap, 3)) * scale
    d.mocap_quat[:] += rng.normal(size=(m.nmocap, 4)) * scale


def states(m, d, count, scale, seed):
    """Puts the data into `count` states, one after the other: the start, then random ones near it, from the third on
    every other one with applied forces. Yields what was set."""
    rng = np.random.default_rng(seed)
    for k in range(count):
        start(m, d)
        if k:
            scatter(m, d, rng, scale)
            d.time = k / 8
        if k and k % 2 == 0:
            d.qfrc_applied[:] = rng.normal(size=m.nv)
            d.xfrc_applied[1:] = rng.normal(size=(m.nbody - 1, 6))
        yield fields(d, STATE)


def fields(d, chosen):
    return {f: text(getattr(d, f)) for f in chosen if np.size(getattr(d, f))}


def pattern(n):
    """A vector that anyone can write down."""
    return np.array([7.0 * i % 5 - 2 for i in range(n)])


def on_request(m, d):
    """What the functions for bodies' forces and momenta compute, and the inverse dynamics of accelerations that anyone can
    write down."""
    mujoco.mj_subtreeVel(m, d)
    mujoco.mj_rnePostConstraint(m, d)
    bodies = fields(d, POST[:-1])
    d.qacc[:] = pattern(m.nv)
    mujoco.mj_inverse(m, d)
    return {**bodies, **fields(d, POST[-1:])}


def functions(m, d):
    """What functions of a vector, a point or two configurations give; the vector is one that anyone can write down."""
    v = pattern(m.nv)
    out, nv = {}, m.nv

    def result(name, of, *shape):
        array = np.zeros(shape)
        of(array)
        out[name] = text(array)

    def pair(name, of):
        jacp, jacr = np.zeros((3, nv)), np.zeros((3, nv))
        of(jacp, jacr)
        out[name] = text(np.concatenate([jacp, jacr]))

    body, point = m.nbody - 1, d.xpos[-1] + [0.1, -0.2, 0.3]
    result("mul_m", lambda a: mujoco.mj_mulM(m, d, a, v), nv)
    result("solve_m", lambda a: mujoco.mj_solveM(m, d, a, v[None]), 1, nv)
    result("solve_m2", lambda a: mujoco.mj_solveM2(m, d, a, v[None], np.sqrt(d.qLDiagInv)), 1, nv)
    result("full_m", lambda a: mujoco.mj_fullM(m, d, a), nv, nv)
    result("rne", lambda a: mujoco.mj_rne(m, d, 0, a), nv)
    d.qacc[:] = v
    result("rne_acc", lambda a: mujoco.mj_rne(m, d, 1, a), nv)
    result("apply_ft", lambda a: mujoco.mj_applyFT(m, d, np.array([1.0, 2, 3]), np.array([-3.0, 1, 2]), point, body, a), nv)
    pair("jac", lambda p, r: mujoco.mj_jac(m, d, p, r, point, body))
    pair("jac_dot", lambda p, r: mujoco.mj_jacDot(m, d, p, r, point, body))
    pair("jac_body", lambda p, r: mujoco.mj_jacBody(m, d, p, r, body))
    pair("jac_body_com", lambda p, r: mujoco.mj_jacBodyCom(m, d, p, r, body))
    if m.ngeom:
        pair("jac_geom", lambda p, r: mujoco.mj_jacGeom(m, d, p, r, m.ngeom - 1))
    if m.nsite:
        pair("jac_site", lambda p, r: mujoco.mj_jacSite(m, d, p, r, m.nsite - 1))
    result("jac_subtree_com", lambda a: mujoco.mj_jacSubtreeCom(m, d, a, min(1, body)), 3, nv)
    moved = d.qpos.copy()
    mujoco.mj_integratePos(m, moved, v, 0.3)
    out["integrate_pos"] = text(moved)
    result("differentiate_pos", lambda a: mujoco.mj_differentiatePos(m, a, 0.2, m.qpos0, d.qpos), nv)
    return out


def inverse_of_steps(m, d):
    """`qfrc_inverse` of the flag `invdiscrete`, for every integrator that has one."""
    out, before = {}, m.opt.integrator
    m.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_INVDISCRETE)
    for i, name in enumerate(INTEGRATORS):
        if name != "RK4":
            m.opt.integrator = i
            d.qacc[:] = pattern(m.nv)
            mujoco.mj_inverse(m, d)
            out[name] = text(d.qfrc_inverse)
    m.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_INVDISCRETE)
    m.opt.integrator = before
    return out


def solution(m, d):
    """The acceleration of the library's own M and forces, refined in extended precision."""
    full = np.zeros((m.nv, m.nv))
    mujoco.mj_fullM(m, d, full)
    x = np.linalg.solve(full, d.qfrc_smooth).astype(np.longdouble)
    for _ in range(5):
        left = d.qfrc_smooth - full.astype(np.longdouble) @ x
        x += np.linalg.solve(full, left.astype(float))
    return x


def sensitivity(m, d):
    """How far the library's own fields move, on the scale that they are compared on, when every coordinate moves by its
    last bit, and how far its acceleration is from the solution of its own equations: what nobody can follow. Only fields
    that are further from themselves than the test allows, and none that jumps."""
    qpos, before = d.qpos.copy(), {f: np.copy(getattr(d, f)) for f in FIELDS}
    spread = {}
    for seed in range(8):
        up = np.random.default_rng(seed).random(m.nq) < 0.5
        # Zero has no last bit: it moves by half of that of 1, with which positions are computed.
        d.qpos[:] = np.where(qpos == 0, np.where(up, 1, -1) * 2.0**-53, np.nextafter(qpos, np.where(up, np.inf, -np.inf)))
        mujoco.mj_forward(m, d)
        for f, a in before.items():
            b = getattr(d, f)
            if a.size and a.shape == b.shape:
                apart = np.abs(a - b).max() / max(1.0, np.abs(a).max())
                spread[f] = max(spread.get(f, 0.0), apart)
    d.qpos[:] = qpos
    mujoco.mj_forward(m, d)
    if m.nv and m.opt.integrator != mujoco.mjtIntegrator.mjINT_DISCRETE:
        apart = float(np.abs(solution(m, d) - d.qacc_smooth).max() / max(1.0, np.abs(d.qacc_smooth).max()))
        for f in ("qacc_smooth", "qacc"):
            spread[f] = max(spread.get(f, 0.0), apart)
    return {f: f"{x:.1e}" for f, x in spread.items() if 1e-10 < x < 1e-6}


def forward(m, count, scale, seed, short):
    """[{"state": {..}, "data": {..}, "spread": {..}, "post": {..}}]: every field after mj_forward, and how far the library
    knows those that depend on the last bits; unless `short`, what is computed on request, too, and for the second state
    what functions give."""
    d, out = mujoco.MjData(m), []
    for k, state in enumerate(states(m, d, count, scale, seed)):
        mujoco.mj_forward(m, d)
        row = {"state": state, "data": fields(d, FIELDS)}
        if spread := sensitivity(m, d):
            row["spread"] = spread
        if not short:
            row["post"] = on_request(m, d)
            if k == 1:
                row["functions"] = functions(m, d)
                row["inverse"] = inverse_of_steps(m, d)
        out.append(row)
    return out


def rollout(m, d, steps, every):
    """Rows of ROW after every so many steps, the start left out."""
    rows = []
    for i in range(1, steps + 1):
        mujoco.mj_step(m, d)
        if i % every == 0:
            rows.append([getattr(d, f).copy() for f in ROW])
    return rows


def trajectory(m, integrator, first, scale, seed, steps=200, every=40, others=15):
    """A trajectory from the first of the states, or from the second, where everything moves. `spread` is how far, in the
    same rows, the library parts from itself when its start is moved by 1e-14, `others` times: chaos, beyond which nobody
    can follow it."""
    m.opt.integrator = integrator
    d, all_rows = mujoco.MjData(m), []
    for k in range(1 + others):
        list(states(m, d, 1 if first else 2, scale, seed))
        if k:
            rng = np.random.default_rng(100 + k)
            mujoco.mj_integratePos(m, d.qpos, rng.normal(size=m.nv) * 1e-14, 1.0)
            d.qvel[:] *= 1 + rng.normal(size=m.nv) * 1e-14
        try:
            all_rows.append(rollout(m, d, steps, every))
        except mujoco.FatalError as e:
            return {"refused": str(e)}
        if k == 0:
            warnings = {mujoco.mjtWarning(i).name: int(w.number) for i, w in enumerate(d.warning) if w.number}
    rows, spread = all_rows[0], []
    for i, row in enumerate(rows):
        scales = [max(1.0, np.abs(a).max(initial=0)) for a in row]
        spread.append(max(np.abs(a - b).max(initial=0) / s for other in all_rows[1:] for a, b, s in zip(row, other[i], scales)))
    return {"steps": steps, "every": every, "spread": " ".join(f"{x:.1e}" for x in spread), "warnings": warnings,
            "rows": [{n: text(a) for n, a in zip(ROW, row) if a.size} for row in rows]}


def record(path, count, scale, short=False, seed=2, steps=200, every=40):
    """All that is recorded of a model file, with its constraints switched off; if `short`, without names and without what is
    computed on request."""
    m = mujoco.MjModel.from_xml_path(str(path))
    m.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
    compiled, states = constants(m), forward(m, count, scale, seed, short)
    if not short:
        compiled["names"] = names(m)
    calm = {name: trajectory(m, i, True, scale, seed, steps, steps) for i, name in enumerate(INTEGRATORS)}
    paths = {name: trajectory(m, i, False, scale, seed, steps, every) for i, name in enumerate(INTEGRATORS)}
    return {"mujoco": mujoco.__version__, "compiled": compiled, "forward": states, "calm": calm, "trajectories": paths}


def write(path, out):
    """One field a line, so that a new recording shows what changed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(out, indent=0) + "\n")
    return path.stat().st_size
