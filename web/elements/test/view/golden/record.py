"""Records scenes, silhouettes and rays with the MuJoCo library, for the tests of the 3D view.

    MUJOCO_GL=osmesa python record.py CORPUS_MODELS SPEC_MODELS

writes scenes.json beside itself: for each scene the fields that the view reads, the camera, which geom is seen in every pixel
(run lengths of ids, row by row from the top; -1 nothing, ngeom + i tendon i), and where rays meet geoms (`mj_ray`).

And textures.json: scenes with textures, and which of red, green and blue are bright in every pixel (run lengths of 4 r + 2 g + b).

And builtin.json: the pixels of builtin textures, beside their declarations.

And floor.json: a floor with a builtin checker in light without direction: which of its two colours is in every pixel (run lengths of 1 and 2; 0 where
neither is, to three levels).

And mirror.json: scenes with a mirror, and in which pixels the library adds the image of something (run lengths of 0 and 1).
"""

import json
import pathlib
import sys

import mujoco
import numpy as np

WIDTH, HEIGHT = 320, 240
# Larger textures are left out, bytes.
SMALL_TEXTURES = 20000

# name: (folder, file, steps, camera); a camera is free (azimuth, elevation, distance, target), fixed or tracking.
SCENES = {
    "arm2": ("corpus", "arm2", 100, (120, -25, 1.9, (0.1, 0, 0.4))),
    "cube_table": ("corpus", "cube_table", 250, (125, -20, 0.9, (0, 0, 0.05))),
    "gantry_gripper": ("corpus", "gantry_gripper", 200, (125, -25, 1.2, (0, 0, 0.15))),
    "gripper": ("corpus", "gripper", 50, (160, -15, 0.4, (0, 0, 0.06))),
    "gripper_wrist": ("corpus", "gripper", 50, "wrist"),
    "incline": ("corpus", "incline", 100, (90, -5, 1.5, (0, 0, 0.2))),
    "joint_zoo": ("corpus", "joint_zoo", 0, (70, -30, 1.6, (0, 0, 0.45))),
    "pendulum": ("corpus", "pendulum", 300, (90, -5, 1.8, (0, 0, 0.75))),
    "tumbling_box": ("corpus", "tumbling_box", 150, (40, -40, 0.8, (0, 0, 0.5))),
    "double_pendulum": ("corpus", "double_pendulum", 200, (60, 10, 1.5, (0, 0, 0.7))),
    "geom_types": ("specs", "zoo/geom_types", 150, (100, -15, 8, (2.5, 0, 0.6))),
    "hfield": ("specs", "zoo/hfield", 120, (35, -30, 3.2, (0, 0, 0))),
    "mesh_builtin": ("specs", "zoo/mesh_builtin", 20, (80, -20, 8, (3, 0, 1))),
    "wrap_cylinder": ("specs", "zoo/tendon_wrap_cylinder", 40, (80, -15, 1.6, (0.1, 0, 0.95))),
    "cameras": ("specs", "zoo/cameras", 10, "world"),
    "looks": ("specs", "zoo/looks", 0, (60, -30, 3, (0, 0, 0.6))),
    "ortho": (None, "ortho", 0, "ortho"),
    "endless": (None, "ortho", 0, (75, -20, 3, (0, 0, 0.2))),
    "track": ("specs", "zoo/geom_types", 150, 4),
}

# A floor without end, an orthographic camera, geoms in a hidden group and behind glass, a directional light.
INLINE = """<mujoco>
  <worldbody>
    <light type="directional" dir="-0.3 0.4 -1"/>
    <camera name="ortho" projection="orthographic" fovy="1.6" pos="1.2 -1.5 1.2" xyaxes="0.78 0.62 0 -0.3 0.38 0.87"/>
    <geom type="plane" size="0 0 0.05"/>
    <geom type="capsule" size="0.08 0.25" pos="-0.4 0 0.35" euler="30 40 0" rgba="0.8 0.3 0.2 1"/>
    <geom type="ellipsoid" size="0.2 0.1 0.15" pos="0 0.3 0.2" euler="0 20 30" rgba="0.2 0.5 0.8 1"/>
    <geom type="cylinder" size="0.12 0.2" pos="0.35 -0.1 0.3" euler="60 0 20" rgba="0.3 0.6 0.3 1"/>
    <geom type="box" size="0.1 0.2 0.05" pos="0 -0.4 0.1" euler="0 0 25" rgba="0.9 0.8 0.3 1"/>
    <geom size="0.3" pos="0 0 0.9" group="3"/>
  </worldbody>
</mujoco>"""

MODEL = """geom_type geom_bodyid geom_group geom_size geom_rgba geom_matid geom_dataid mesh_vertadr mesh_vertnum mesh_faceadr mesh_facenum
mesh_normaladr mesh_texcoordadr mesh_texcoordnum mesh_vert mesh_normal mesh_texcoord mesh_face mesh_facenormal mesh_facetexcoord hfield_size
hfield_nrow hfield_ncol hfield_adr hfield_data mat_texid mat_texuniform mat_texrepeat mat_emission mat_specular mat_shininess
mat_reflectance mat_rgba site_type site_bodyid site_group site_size site_rgba site_matid light_type light_castshadow light_active
light_attenuation light_cutoff light_exponent light_ambient light_diffuse light_specular cam_fovy cam_projection jnt_type jnt_bodyid
body_parentid body_mass body_subtreemass tendon_width tendon_rgba""".split()

FRAME = """geom_xpos geom_xmat site_xpos site_xmat xpos xmat xipos subtree_com xanchor xaxis cam_xpos cam_xmat light_xpos light_xdir
ten_wrapadr ten_wrapnum wrap_obj wrap_xpos""".split()


def numbers(values):
    """A flat list of numbers; floats as short as single precision needs."""
    flat = np.asarray(values).ravel()
    return [int(v) if flat.dtype.kind in "iub" else float(f"{v:.8g}") for v in flat]


def textures(m):
    out = []
    for i in range(m.ntex):
        count = int(m.tex_width[i] * m.tex_height[i] * m.tex_nchannel[i])
        data = m.tex_data[m.tex_adr[i] : m.tex_adr[i] + count]
        out.append({"type": int(m.tex_type[i]), "width": int(m.tex_width[i]), "height": int(m.tex_height[i]),
                    "channels": int(m.tex_nchannel[i]), "data": numbers(data)})
    return out


def contacts(m, d):
    out = []
    for i in range(d.ncon):
        force = np.zeros(6)
        mujoco.mj_contactForce(m, d, i, force)
        frame = d.contact[i].frame.reshape(3, 3)
        out.append({"pos": numbers(d.contact[i].pos), "normal": numbers(frame[0]), "force": numbers(frame.T @ force[:3]),
                    "geom1": int(d.contact[i].geom[0]), "geom2": int(d.contact[i].geom[1])})
    return out


def cameras(m, spec):
    """The camera for the library, and the same for the view."""
    c = mujoco.MjvCamera()
    if isinstance(spec, str):
        c.type, c.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, m.camera(spec).id
        return c, {"fixed": c.fixedcamid}
    if isinstance(spec, int):
        c.type, c.trackbodyid = mujoco.mjtCamera.mjCAMERA_TRACKING, spec
        c.azimuth, c.elevation, c.distance = 50, -20, 3
        return c, {"track": spec, "azimuth": 50, "elevation": -20, "distance": 3}
    c.azimuth, c.elevation, c.distance = spec[:3]
    c.lookat[:] = spec[3]
    return c, {"azimuth": spec[0], "elevation": spec[1], "distance": spec[2], "target": list(spec[3])}


def runs(ids):
    flat, out, start = ids.ravel(), [], 0
    for i in range(1, len(flat) + 1):
        if i == len(flat) or flat[i] != flat[start]:
            out += [int(flat[start]), i - start]
            start = i
    return out


def silhouettes(m, d, camera):
    option = mujoco.MjvOption()
    option.sitegroup[:] = 0
    with mujoco.Renderer(m, HEIGHT, WIDTH) as renderer:
        renderer.enable_segmentation_rendering()
        # A tracking camera follows with a delay, and comes to rest after some pictures.
        for _ in range(200):
            renderer.update_scene(d, camera, option)
        seen = renderer.render()
    ids = np.full((HEIGHT, WIDTH), -1)
    for kind, shift in [(mujoco.mjtObj.mjOBJ_GEOM, 0), (mujoco.mjtObj.mjOBJ_TENDON, m.ngeom)]:
        ids = np.where(seen[..., 1] == kind, seen[..., 0] + shift, ids)
    return runs(ids)


def rays(m, d, random):
    out = []
    visible = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)
    for i in range(60):
        aim = d.geom_xpos[random.integers(m.ngeom)] + random.normal(size=3) * 0.1 * m.stat.extent
        start = m.stat.center + random.normal(size=3) * 1.5 * m.stat.extent
        start[2] = abs(start[2]) + 0.2
        direction = (aim - start) / np.linalg.norm(aim - start)
        geom = np.zeros(1, dtype=np.int32)
        distance = mujoco.mj_ray(m, d, start, direction, visible, 1, -1, geom)
        out.append({"from": start.tolist(), "direction": direction.tolist(), "geom": int(geom[0]), "distance": float(distance)})
    return out


def scene(m, d):
    """The fields of a scene that the view reads."""
    model = {name: numbers(getattr(m, name)) for name in MODEL}
    model |= {"center": numbers(m.stat.center), "extent": float(m.stat.extent), "fovy": float(m.vis.global_.fovy),
              "cameras": [m.camera(i).name for i in range(m.ncam)]}
    if 0 < m.tex_data.size <= SMALL_TEXTURES:
        model["textures"] = textures(m)
    frame = {name: numbers(getattr(d, name)) for name in FRAME}
    frame |= {"time": d.time, "contacts": contacts(m, d)}
    return {"model": model, "frame": frame}


def record(path, steps, spec, random):
    m = mujoco.MjModel.from_xml_path(str(path)) if path else mujoco.MjModel.from_xml_string(INLINE)
    d = mujoco.MjData(m)
    for _ in range(steps):
        mujoco.mj_step(m, d)
    mujoco.mj_forward(m, d)
    library, camera = cameras(m, spec)
    return scene(m, d) | {"camera": camera, "seen": silhouettes(m, d, library), "rays": rays(m, d, random)}


def tile(color, size=8):
    """A colour; in the upper half white on the left and another colour on the right."""
    pixels = np.empty((size, size, 3), np.uint8)
    pixels[:] = color
    pixels[: size // 2, : size // 2] = 255
    pixels[: size // 2, size // 2 :] = np.roll(color, 1)
    return pixels


def textured(has_sky):
    """Planes, boxes, balls and meshes with textures of all kinds, or a sky."""
    spec = mujoco.MjSpec()
    colors = [(255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0), (255, 0, 255), (0, 255, 255)]
    cube = np.concatenate([tile(c) for c in colors]).ravel().tolist()
    kinds = mujoco.mjtTexture
    for name, kind in [("cube", kinds.mjTEXTURE_CUBE)] + [("sky", kinds.mjTEXTURE_SKYBOX)] * has_sky:
        spec.add_texture(name=name, type=kind, width=8, height=48, nchannel=3, data=cube)
    spec.add_texture(name="flat", type=kinds.mjTEXTURE_2D, width=8, height=8, nchannel=3, data=tile((255, 0, 0)).ravel().tolist())
    for texture in ["cube", "flat"]:
        for uniform in [0, 1]:
            material = spec.add_material(name=f"{texture}{uniform}", texuniform=uniform, texrepeat=[3, 2], specular=0)
            material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = texture
    corners = [-1, -0.5, -1, 1, -0.5, -1, 1, -0.5, 1, -1, -0.5, 1, 0, 0.5, 0]
    spec.add_mesh(name="wedge", uservert=[0.4 * x for x in corners], usertexcoord=[0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5],
                  userface=[0, 1, 2, 0, 2, 3, 1, 0, 4, 2, 1, 4, 3, 2, 4, 0, 3, 4])
    types = mujoco.mjtGeom
    for uniform, x in [] if has_sky else [(0, -2), (1, 2)]:
        add = spec.worldbody.add_geom
        add(type=types.mjGEOM_PLANE, size=[1.9, 1.5, 0.1], pos=[x, 0, 0], material=f"flat{uniform}")
        add(type=types.mjGEOM_BOX, size=[0.4, 0.3, 0.2], pos=[x - 1, 0, 0.8], material=f"cube{uniform}")
        add(type=types.mjGEOM_BOX, size=[0.4, 0.3, 0.2], pos=[x, 0, 0.8], material=f"flat{uniform}")
        add(type=types.mjGEOM_SPHERE, size=[0.3, 0, 0], pos=[x, 0.2, 1.6], material=f"cube{uniform}")
        add(type=types.mjGEOM_MESH, meshname="wedge", pos=[x + 1, 0, 0.8], material=f"flat{uniform}")
    model = spec.compile()
    model.vis.headlight.ambient[:] = 0.6
    return model


TEXTURED = {
    "left": (False, (90, -40, 4.5, (-2, 0, 0.6))),
    "right": (False, (90, -40, 4.5, (2, 0, 0.6))),
    "side": (False, (20, -10, 4.5, (1, 0, 0.6))),
    "back": (False, (215, -30, 5, (0, 0, 0.6))),
    "sky": (True, (35, 10, 3, (0, 0, 0))),
    "sky_down": (True, (200, -70, 3, (0, 0, 0))),
}


def record_textures(has_sky, spec):
    m = textured(has_sky)
    d = mujoco.MjData(m)
    mujoco.mj_forward(m, d)
    library, camera = cameras(m, spec)
    with mujoco.Renderer(m, HEIGHT, WIDTH) as renderer:
        renderer.update_scene(d, library)
        rgb = renderer.render().astype(int)
    bright = rgb > np.maximum(0.5 * rgb.max(axis=2, keepdims=True), 10)
    return scene(m, d) | {"camera": camera, "colors": runs(bright @ [4, 2, 1])}


# Declarations of builtin textures; marks at random pixels are left out, because the library's random numbers are its own.
BUILTIN = {
    "gradient": dict(type="2d", builtin="gradient", rgb1="1 0.25 0", rgb2="0 0.5 0.999", width="17", height="12"),
    "sky": dict(type="skybox", builtin="gradient", rgb1="0.3 0.5 0.7", rgb2="0 0 0", width="16", height="96"),
    "cube_gradient": dict(type="cube", builtin="gradient", rgb1="1 0 0", rgb2="0 1 0.5", width="9", height="9"),
    "checker": dict(type="2d", builtin="checker", rgb1="0.1 0.2 0.3", rgb2="0.2 0.3 0.4", width="7", height="5"),
    "checker_edge": dict(type="2d", builtin="checker", mark="edge", markrgb="0.8 0.8 0.8", width="8", height="6"),
    "cube_checker": dict(type="cube", builtin="checker", mark="cross", markrgb="1 1 1", rgb1="1 0 0", rgb2="0 1 0", width="6", height="36"),
    "flat": dict(type="2d", builtin="flat", rgb1="0.2 0.333 0.9999", width="3", height="2"),
    "cube_flat": dict(type="cube", builtin="flat", mark="edge", markrgb="0 0 1", rgb2="0.501 0.5 0.75", width="4", height="24"),
}


def record_builtin(attributes):
    text = " ".join(f"{name}='{value}'" for name, value in attributes.items())
    m = mujoco.MjModel.from_xml_string(f"<mujoco><asset><texture name='t' {text}/></asset><worldbody><geom size='1'/></worldbody></mujoco>")
    return {"attributes": attributes, "texture": textures(m)[0]}


FLOOR = """<mujoco>
  <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <asset>
    <texture name="t" type="2d" builtin="checker" rgb1="0.7 0.3 0.2" rgb2="0.2 0.4 0.6" width="64" height="64"/>
    <material name="m" texture="t" texrepeat="2 3" specular="0" reflectance="0" {uniform}/>
  </asset>
  <worldbody><geom type="plane" size="{size}" material="m"/><geom size="0.1" pos="0 0 0.1"/></worldbody>
</mujoco>"""


def record_floor(size, uniform):
    m = mujoco.MjModel.from_xml_string(FLOOR.format(size=size, uniform='texuniform="true"' if uniform else ""))
    d = mujoco.MjData(m)
    mujoco.mj_forward(m, d)
    library, camera = cameras(m, (70, -50, 3, (0, 0, 0)))
    with mujoco.Renderer(m, HEIGHT, WIDTH) as renderer:
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION, mujoco.mjtRndFlag.mjRND_HAZE):
            renderer.scene.flags[flag] = 0
        renderer.update_scene(d, library)
        rgb = renderer.render().astype(int)
    which = np.zeros((HEIGHT, WIDTH), int)
    for i, color in enumerate([(0.7, 0.3, 0.2), (0.2, 0.4, 0.6)]):
        which = np.where(np.abs(rgb - np.floor(255 * np.array(color))).max(axis=2) <= 3, i + 1, which)
    recorded = scene(m, d)
    # The view computes the pixels of the texture.
    recorded["model"].pop("textures", None)
    return recorded | {"camera": camera, "colors": runs(which)}


# A floor, and boxes in a turned mirror; what is mirrored shines, and lies in front of the mirror, behind it or inside it.
MIRROR = """<mujoco>
  <visual><headlight ambient="0.1 0.1 0.1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <asset>
    <material name="mirror" rgba="0.1 0.2 0.4 1" specular="0" reflectance="{reflectance}"/>
    <material name="second" rgba="0.1 0.2 0.4 1" specular="0" reflectance="0.9"/>
    <material name="bright" rgba="1 0.5 0 1" emission="1" specular="0"/>
  </asset>
  <worldbody>
    {mirror}
    <geom type="box" size="0.1 0.1 0.1" pos="1 0.3 0.1" material="second"/>
    <geom type="ellipsoid" size="0.3 0.2 0.15" pos="0 0 0.5" euler="20 30 0" material="bright"/>
    <geom type="capsule" size="0.1 0.3" pos="-0.5 0.3 0.25" euler="0 40 0" material="bright"/>
    <geom size="0.15" pos="0.5 0.1 0" material="bright"/>
  </worldbody>
</mujoco>"""
MIRRORS = {
    "floor": ('<geom type="plane" size="2 2 0.1" material="mirror"/>', (90, -25, 3, (0, 0, 0.1))),
    "endless": ('<geom type="plane" size="0 0 0.1" material="mirror"/>', (40, -35, 3, (0, 0, 0.2))),
    "box": ('<geom type="box" size="1.5 1.2 0.1" pos="0 0 -0.2" euler="10 -15 0" material="mirror"/>', (120, -30, 3.5, (0, 0, 0.1))),
    "below": ('<geom type="plane" size="2 2 0.1" euler="0 180 0" material="mirror"/>', (90, -25, 3, (0, 0, 0.1))),
}


def record_mirror(mirror, spec):
    def picture(reflectance):
        m = mujoco.MjModel.from_xml_string(MIRROR.format(mirror=mirror, reflectance=reflectance))
        d = mujoco.MjData(m)
        mujoco.mj_forward(m, d)
        library, camera = cameras(m, spec)
        with mujoco.Renderer(m, HEIGHT, WIDTH) as renderer:
            for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_HAZE):
                renderer.scene.flags[flag] = 0
            renderer.update_scene(d, library)
            return m, d, camera, renderer.render().astype(int)

    m, d, camera, rgb = picture(0.5)
    added = (rgb - picture(0)[3]).max(axis=2) > 60
    return scene(m, d) | {"camera": camera, "added": runs(added.astype(int))}


def write(name, scenes):
    lines = [f"{json.dumps(name)}: {json.dumps(scene, separators=(',', ':'))}" for name, scene in scenes.items()]
    text = "{\n" + ",\n".join(lines) + "\n}\n"
    pathlib.Path(__file__).with_name(name).write_text(text)


def main(corpus, specs):
    folders = {"corpus": pathlib.Path(corpus), "specs": pathlib.Path(specs)}
    random = np.random.default_rng(7)
    scenes = {name: record(folder and folders[folder] / f"{file}.xml", steps, camera, random) for name, (folder, file, steps, camera) in SCENES.items()}
    write("scenes.json", scenes)
    write("builtin.json", {name: record_builtin(attributes) for name, attributes in BUILTIN.items()})
    floors = {"sized": ("1 1.5 0.1", False), "uniform": ("1 1.5 0.1", True), "endless": ("0 0 0.1", True)}
    write("floor.json", {name: record_floor(*about) for name, about in floors.items()})
    write("mirror.json", {name: record_mirror(*about) for name, about in MIRRORS.items()})
    write("textures.json", {name: record_textures(*about) for name, about in TEXTURED.items()})


main(*sys.argv[1:])
