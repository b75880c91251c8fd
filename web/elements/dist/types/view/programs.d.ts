/** The programs of the graphics processor (GLSL ES 3.0). Colours are linear inside, sRGB outside, and premultiplied by alpha. */
/** Lights of a scene that are drawn; the first is the headlight. */
export declare const MAX_LIGHTS = 8;
/** What a surface shows besides its colour: `instances.ts` writes these numbers. */
export declare const PATTERN: {
    readonly plain: 0;
    readonly grid: 1;
    readonly checker: 2;
    readonly fading: 4;
};
/** Where texture coordinates come from: the mesh, the faces of a box (or of what is inside it), a plane without end, a direction;
 * `uniform` is added for metres. */
export declare const TEXTURE_MODE: {
    readonly none: 0;
    readonly mesh: 1;
    readonly box: 2;
    readonly endless: 3;
    readonly cube: 4;
    readonly uniform: 8;
};
export declare const SURFACE_VERTEX = "#version 300 es\nprecision highp float;\nlayout(location=0) in vec4 a_position;\nlayout(location=1) in vec3 a_normal;\nlayout(location=2) in vec2 a_uv;\nlayout(location=3) in vec4 i_x;\nlayout(location=4) in vec4 i_y;\nlayout(location=5) in vec4 i_z;\nlayout(location=6) in vec4 i_scale;\nlayout(location=7) in vec4 i_color;\nlayout(location=8) in vec4 i_material;\nlayout(location=9) in vec4 i_extra;\nuniform mat4 u_projection;\nvec3 local() { return a_position.xyz * i_scale.xyz + vec3(0, 0, a_position.w * i_scale.w); }\nvec3 toWorld(vec3 p) { vec4 q = vec4(p, 1); return vec3(dot(i_x, q), dot(i_y, q), dot(i_z, q)); }\n\nout vec3 v_world, v_normal, v_local, v_unit;\nout vec2 v_uv;\nflat out vec4 v_color, v_material, v_extra;\nflat out vec3 v_size;\nvoid main() {\n  v_local = local();\n  v_unit = a_position.xyz;\n  v_size = i_scale.xyz;\n  v_world = toWorld(v_local);\n  vec3 n = a_normal / i_scale.xyz;\n  v_normal = vec3(dot(i_x.xyz, n), dot(i_y.xyz, n), dot(i_z.xyz, n));\n  v_uv = a_uv;\n  v_color = i_color; v_material = i_material; v_extra = i_extra;\n  gl_Position = u_projection * vec4(v_world, 1);\n}";
export declare const SURFACE_FRAGMENT: string;
export declare const SHADOW_VERTEX = "#version 300 es\nprecision highp float;\nlayout(location=0) in vec4 a_position;\nlayout(location=1) in vec3 a_normal;\nlayout(location=2) in vec2 a_uv;\nlayout(location=3) in vec4 i_x;\nlayout(location=4) in vec4 i_y;\nlayout(location=5) in vec4 i_z;\nlayout(location=6) in vec4 i_scale;\nlayout(location=7) in vec4 i_color;\nlayout(location=8) in vec4 i_material;\nlayout(location=9) in vec4 i_extra;\nuniform mat4 u_projection;\nvec3 local() { return a_position.xyz * i_scale.xyz + vec3(0, 0, a_position.w * i_scale.w); }\nvec3 toWorld(vec3 p) { vec4 q = vec4(p, 1); return vec3(dot(i_x, q), dot(i_y, q), dot(i_z, q)); }\n\nvoid main() { gl_Position = u_projection * vec4(toWorld(local()), 1); }";
export declare const SHADOW_FRAGMENT = "#version 300 es\nprecision mediump float;\nvoid main() {}";
/** Lines of a width in pixels: a quad for each piece, which ends in half circles' squares. */
export declare const LINE_VERTEX = "#version 300 es\nprecision highp float;\nlayout(location=0) in vec2 a_corner;\nlayout(location=1) in vec3 i_from;\nlayout(location=2) in vec3 i_to;\nlayout(location=3) in vec4 i_color;\nlayout(location=4) in float i_width;\nuniform mat4 u_projection;\nuniform vec2 u_size;\nout vec4 v_color;\nvoid main() {\n  vec4 p = u_projection * vec4(i_from, 1), q = u_projection * vec4(i_to, 1);\n  float near = 1e-4;\n  if (p.w < near && q.w >= near) p = mix(p, q, (near - p.w) / (q.w - p.w));\n  if (q.w < near && p.w >= near) q = mix(q, p, (near - q.w) / (p.w - q.w));\n  vec2 d = (q.xy / q.w - p.xy / p.w) * u_size;\n  float n = length(d);\n  d = n > 1e-6 ? d / n : vec2(1, 0);\n  vec4 end = a_corner.x < 0.5 ? p : q;\n  vec2 offset = (vec2(-d.y, d.x) * a_corner.y + d * (a_corner.x - 0.5)) * i_width;\n  gl_Position = end + vec4(offset / u_size * end.w, 0, 0);\n  v_color = i_color;\n}";
export declare const LINE_FRAGMENT = "#version 300 es\nprecision mediump float;\nin vec4 v_color;\nuniform float u_alpha;\nout vec4 result;\nvoid main() { result = vec4(v_color.rgb, 1) * (v_color.a * u_alpha); }";
/** The sky box: a triangle that covers the picture. */
export declare const SKY_VERTEX = "#version 300 es\nprecision highp float;\nuniform vec3 u_forward, u_right, u_up;\nout vec3 v_direction;\nvoid main() {\n  vec2 p = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);\n  v_direction = u_forward + p.x * u_right + p.y * u_up;\n  gl_Position = vec4(p, 0.9999999, 1);\n}";
export declare const SKY_FRAGMENT = "#version 300 es\nprecision highp float;\nin vec3 v_direction;\nuniform samplerCube u_cube;\nout vec4 result;\nvoid main() { result = vec4(texture(u_cube, v_direction.xzy * vec3(1, 1, -1)).rgb, 1); }";
