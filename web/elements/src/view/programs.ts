/** The programs of the graphics processor (GLSL ES 3.0). Colours are linear inside, sRGB outside, and premultiplied by alpha. */

/** Lights of a scene that are drawn; the first is the headlight. */
export const MAX_LIGHTS = 8;

/** What a surface shows besides its colour: `instances.ts` writes these numbers. */
export const PATTERN = { plain: 0, grid: 1, checker: 2, fading: 4, mirror: 8 } as const;
/** Where texture coordinates come from: the mesh, the faces of a box (or of what is inside it), a plane without end, a direction in the
 * shape of size 1 or in metres. */
export const TEXTURE_MODE = { none: 0, mesh: 1, box: 2, endless: 3, cube: 4, cubeOfMetres: 5 } as const;

/** Attributes by location: three of the shape, six of the instance. */
const INSTANCE = `#version 300 es
precision highp float;
layout(location=0) in vec4 a_position;
layout(location=1) in vec3 a_normal;
layout(location=2) in vec2 a_uv;
layout(location=3) in vec4 i_x;
layout(location=4) in vec4 i_y;
layout(location=5) in vec4 i_z;
layout(location=6) in vec4 i_scale;
layout(location=7) in vec4 i_color;
layout(location=8) in vec4 i_material;
layout(location=9) in vec4 i_extra;
uniform mat4 u_projection;
vec3 local() { return a_position.xyz * i_scale.xyz + vec3(0, 0, a_position.w * i_scale.w); }
vec3 toWorld(vec3 p) { vec4 q = vec4(p, 1); return vec3(dot(i_x, q), dot(i_y, q), dot(i_z, q)); }
`;

export const SURFACE_VERTEX = `${INSTANCE}
out vec3 v_world, v_normal, v_local, v_unit;
out vec2 v_uv;
flat out vec4 v_color, v_material, v_extra;
void main() {
  v_local = local();
  v_unit = a_position.xyz;
  v_world = toWorld(v_local);
  vec3 n = a_normal / i_scale.xyz;
  v_normal = vec3(dot(i_x.xyz, n), dot(i_y.xyz, n), dot(i_z.xyz, n));
  v_uv = a_uv;
  v_color = i_color; v_material = i_material; v_extra = i_extra;
  // Of a box, the upper face is the mirror.
  if (a_normal.z < 0.5 && (int(i_extra.w) & ${PATTERN.mirror}) != 0) v_extra.w -= ${PATTERN.mirror}.0;
  gl_Position = u_projection * vec4(v_world, 1);
}`;

export const SURFACE_FRAGMENT = `#version 300 es
precision highp float;
precision highp sampler2DShadow;
in vec3 v_world, v_normal, v_local, v_unit;
in vec2 v_uv;
flat in vec4 v_color, v_material, v_extra;
uniform vec4 u_eye;
uniform int u_lights, u_shadowLight;
uniform vec4 u_lightPosition[${MAX_LIGHTS}];
uniform vec4 u_lightDirection[${MAX_LIGHTS}];
uniform vec4 u_lightDiffuse[${MAX_LIGHTS}];
uniform vec3 u_lightSpecular[${MAX_LIGHTS}];
uniform vec3 u_lightAttenuation[${MAX_LIGHTS}];
uniform vec3 u_sky, u_ground;
uniform mat4 u_shadowMatrix;
uniform vec3 u_shadowTexel;
uniform sampler2DShadow u_shadow;
uniform sampler2D u_texture;
uniform samplerCube u_cube;
uniform vec4 u_grid;
uniform float u_alpha;
// The plane in front of which surfaces are drawn, and the scene as the mirror shows it, at the same pixels.
uniform vec4 u_front;
uniform sampler2D u_mirror;
out vec4 result;

vec3 linear(vec3 c) { return c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878); }
vec3 display(vec3 c) {
  vec3 soft = mix(c, 0.75 + 0.25 * (1.0 - exp((0.75 - c) * 4.0)), step(0.75, c));
  return max(1.055 * pow(max(soft, 0.0), vec3(0.416666667)) - 0.055, 0.0);
}

float lit(vec3 n) {
  if (u_shadowLight < 0) return 1.0;
  vec4 p = u_shadowMatrix * vec4(v_world + n * u_shadowTexel.y, 1);
  vec3 q = p.xyz / p.w * 0.5 + 0.5;
  if (p.w <= 0.0 || any(lessThan(q, vec3(0))) || any(greaterThan(q, vec3(1)))) return 1.0;
  // The mean of 5 × 5 comparisons, each between four texels, is one of 6 × 6 texels: the outer ones count in part. Nine comparisons, each
  // between the four texels that it covers, have the same weights.
  vec2 t = q.xy / u_shadowTexel.x - 0.5, first = floor(t), f = t - first;
  vec2 weights[3] = vec2[3](2.0 - f, vec2(2), 1.0 + f);
  vec2 offsets[3] = vec2[3](1.0 / (2.0 - f) - 1.5, vec2(1), 2.5 + f / (1.0 + f));
  float sum = 0.0;
  for (int y = 0; y < 3; y++)
    for (int x = 0; x < 3; x++)
      sum += weights[x].x * weights[y].y
        * texture(u_shadow, vec3((first + vec2(offsets[x].x, offsets[y].y)) * u_shadowTexel.x, q.z - u_shadowTexel.z));
  return sum / 25.0;
}

// To the right and downwards on each face of a box, seen from outside with z upwards.
vec2 boxCoordinates() {
  vec3 u = v_unit, side = abs(u);
  vec2 p = u.xy * vec2(1, sign(u.z + 1e-6));
  if (side.y > 0.9999 && side.z < 0.9999) p = vec2(-u.x * sign(u.y), u.z);
  else if (side.x > 0.9999 && side.z < 0.9999) p = vec2(u.y * sign(u.x), u.z);
  return 0.5 + vec2(0.5, -0.5) * p;
}

float gridLine(vec2 p, float cell, float width) {
  vec2 x = p / cell, d = fwidth(x);
  vec2 line = 1.0 - smoothstep(d * width, d * (width + 1.0), abs(fract(x - 0.5) - 0.5));
  return max(line.x * (1.0 - smoothstep(0.1, 0.5, d.x)), line.y * (1.0 - smoothstep(0.1, 0.5, d.y)));
}

void main() {
  if (dot(u_front, vec4(v_world, 1)) < 0.0) discard;
  vec4 color = v_color;
  color.a *= u_alpha;
  vec3 base = linear(color.rgb);
  int mode = int(v_extra.z), pattern = int(v_extra.w);
  if (mode == ${TEXTURE_MODE.cube}) base *= linear(texture(u_cube, v_unit).rgb);
  else if (mode == ${TEXTURE_MODE.cubeOfMetres}) base *= linear(texture(u_cube, v_local).rgb);
  else if (mode != ${TEXTURE_MODE.none}) {
    // A tile of a plane without end has its middle at the origin.
    vec2 uv = mode == ${TEXTURE_MODE.endless} ? 0.5 + vec2(0.5, -0.5) * v_local.xy * v_extra.xy
      : (mode == ${TEXTURE_MODE.mesh} ? v_uv : boxCoordinates()) * v_extra.xy;
    vec4 t = texture(u_texture, uv);
    base *= linear(t.rgb); color.a *= t.a;
  }
  bool isPlane = (pattern & ${PATTERN.grid}) != 0;
  if (isPlane) {
    vec3 lineColor = dot(base, vec3(0.3, 0.6, 0.1)) > 0.2 ? vec3(0.1, 0.13, 0.16) : vec3(0.55, 0.6, 0.65);
    float line = max(gridLine(v_local.xy, u_grid.x, 0.3) * 0.45, gridLine(v_local.xy, u_grid.x * 5.0, 0.5));
    base = mix(base, lineColor, line * u_grid.w);
  }
  if ((pattern & ${PATTERN.checker}) != 0) {
    vec3 s = sign(v_unit);
    base = s.x * s.y * s.z > 0.0 ? base : vec3(0.01);
  }
  if ((pattern & ${PATTERN.fading}) != 0) color.a *= 1.0 - smoothstep(u_grid.y, u_grid.z, distance(v_world, u_eye.w > 0.5 ? u_eye.xyz : v_world));
  vec3 n = normalize(v_normal);
  if (!gl_FrontFacing) { n = -n; if (isPlane) color.a *= 0.35; }
  vec3 toEye = normalize(u_eye.xyz - v_world * u_eye.w);
  vec3 diffuse = mix(u_ground, u_sky, n.z * 0.5 + 0.5), gloss = vec3(0);
  float exponent = max(v_material.z * 128.0, 1.0);
  for (int i = 0; i < ${MAX_LIGHTS}; i++) {
    if (i >= u_lights) break;
    vec3 d = u_lightPosition[i].xyz - v_world * u_lightPosition[i].w;
    float range = length(d), strength = 1.0;
    vec3 l = d / range;
    if (u_lightPosition[i].w > 0.5) {
      vec3 k = u_lightAttenuation[i];
      strength /= max(k.x + k.y * range + k.z * range * range, 1e-6);
      float c = dot(-l, u_lightDirection[i].xyz), cutoff = u_lightDirection[i].w;
      if (cutoff > -1.0) strength *= smoothstep(cutoff, mix(cutoff, 1.0, 0.15), c) * pow(max(c, 0.0), u_lightDiffuse[i].w * 0.25);
    }
    float facing = dot(n, l);
    if (facing <= 0.0 || strength <= 0.0) continue;
    if (i == u_shadowLight) strength *= lit(n);
    diffuse += u_lightDiffuse[i].rgb * (facing * strength);
    gloss += u_lightSpecular[i] * (strength * pow(max(dot(n, normalize(l + toEye)), 0.0), exponent));
  }
  vec3 shade = base * (diffuse + v_material.x) + gloss * v_material.y * 0.5 * (isPlane ? 0.15 : 1.0);
  vec3 shown = display(shade);
  if ((pattern & ${PATTERN.mirror}) != 0)
    shown = min(shown + v_material.w * texelFetch(u_mirror, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
  result = vec4(shown * color.a, color.a);
}`;

export const SHADOW_VERTEX = `${INSTANCE}
void main() { gl_Position = u_projection * vec4(toWorld(local()), 1); }`;

export const SHADOW_FRAGMENT = `#version 300 es
precision mediump float;
void main() {}`;

/** Lines of a width in pixels: a quad for each piece, which ends in half circles' squares. */
export const LINE_VERTEX = `#version 300 es
precision highp float;
layout(location=0) in vec2 a_corner;
layout(location=1) in vec3 i_from;
layout(location=2) in vec3 i_to;
layout(location=3) in vec4 i_color;
layout(location=4) in float i_width;
uniform mat4 u_projection;
uniform vec2 u_size;
out vec4 v_color;
void main() {
  vec4 p = u_projection * vec4(i_from, 1), q = u_projection * vec4(i_to, 1);
  float near = 1e-4;
  if (p.w < near && q.w >= near) p = mix(p, q, (near - p.w) / (q.w - p.w));
  if (q.w < near && p.w >= near) q = mix(q, p, (near - q.w) / (p.w - q.w));
  vec2 d = (q.xy / q.w - p.xy / p.w) * u_size;
  float n = length(d);
  d = n > 1e-6 ? d / n : vec2(1, 0);
  vec4 end = a_corner.x < 0.5 ? p : q;
  vec2 offset = (vec2(-d.y, d.x) * a_corner.y + d * (a_corner.x - 0.5)) * i_width;
  gl_Position = end + vec4(offset / u_size * end.w, 0, 0);
  v_color = i_color;
}`;

export const LINE_FRAGMENT = `#version 300 es
precision mediump float;
in vec4 v_color;
uniform float u_alpha;
out vec4 result;
void main() { result = vec4(v_color.rgb, 1) * (v_color.a * u_alpha); }`;

/** The sky box: a triangle that covers the picture. */
export const SKY_VERTEX = `#version 300 es
precision highp float;
uniform vec3 u_forward, u_right, u_up;
out vec3 v_direction;
void main() {
  vec2 p = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);
  v_direction = u_forward + p.x * u_right + p.y * u_up;
  gl_Position = vec4(p, 0.9999999, 1);
}`;

export const SKY_FRAGMENT = `#version 300 es
precision highp float;
in vec3 v_direction;
uniform samplerCube u_cube;
out vec4 result;
void main() { result = vec4(texture(u_cube, v_direction.xzy * vec3(1, 1, -1)).rgb, 1); }`;
