// Constants and structures that C and GLSL both read.
#ifdef GL_core_profile
#define SHARED_UINT uint
#define SHARED_VEC3 vec3
#define SHARED_VEC4 vec4
#define SHARED_UVEC4 uvec4
#define SHARED_MAT4 mat4
#define SHARED_LIGHT light_entry
#else
#pragma once
#include <stdint.h>
typedef struct shared_vec3 {
    float v[3];
} shared_vec3;
typedef struct shared_vec4 {
    float v[4];
} shared_vec4;
typedef struct shared_uvec4 {
    uint32_t v[4];
} shared_uvec4;
typedef struct shared_mat4 {
    float m[16];
} shared_mat4; // column-major
#define SHARED_UINT uint32_t
#define SHARED_VEC3 shared_vec3
#define SHARED_VEC4 shared_vec4
#define SHARED_UVEC4 shared_uvec4
#define SHARED_MAT4 shared_mat4
#define SHARED_LIGHT struct light_entry
#endif

// Uniform block "Frame" of every shader that includes lib/frame.glsl.
struct frame_block {
    SHARED_MAT4 view;         // world to camera; the camera looks along -z
    SHARED_MAT4 projection;   // camera to clip; depth 0 near, 1 far
    SHARED_MAT4 view_inverse; // camera to world
    SHARED_MAT4 last;         // world to clip of the frame before; of this one in the first
    SHARED_VEC4 eye;   // xyz: metres; w: by how much an orthographic camera stands behind its
                       // place (m), 0 in perspective
    SHARED_VEC4 lens;  // tan(half width), tan(half height), near, far (metres)
    SHARED_VEC4 shift; // of a host's camera: xy: by how much what lies straight ahead is seen right
                       // of the middle of the picture and above it, in halves of it; zw: by how much
                       // its jitter has moved the picture since the last frame, to the right and
                       // down, in parts of it
    SHARED_VEC4 sight; // xy: by how much the slopes of lines of sight (to the right, up) are moved
                       // in this picture, which view, view_inverse and eye have in them; z: radius
                       // of the camera's lens (m), 0: all is sharp; w: depth that is sharp (m)
    SHARED_VEC4 time;  // seconds, seconds since the last frame, number of the frame shown, which of
                       // the pictures of a shutter this is, from 1; 0: there is but one
    SHARED_UVEC4 size; // output width, height, frames drawn so far (for noise), seed
    SHARED_VEC4 sun_direction; // xyz: towards the sun, unit; w: angular radius of the moon that is
                               // seen there, radians
    SHARED_VEC4 sun_radiance;  // rgb: irradiance at normal incidence over pi
    SHARED_VEC4 sky_zenith;    // rgb: radiance straight up, about; w: factor of the sky's image, 0:
                               // there is none
    SHARED_VEC4
    sky_horizon; // rgb: radiance at the horizon, about; w: how far the image is turned, radians
    SHARED_VEC4 night_zenith;  // rgb: radiance of the night sky straight up; w: how much of the sky
                               // is night, 0..1
    SHARED_VEC4 night_horizon; // rgb: at the horizon; w: factor of what stars and the moon shine
};

// Kinds of light, in light_entry.color.w.
#define LIGHT_SUN 0   // far away: the same direction everywhere
#define LIGHT_POINT 1 // a glowing sphere where its radius is above 0
#define LIGHT_SPOT 2  // a point light with a cone
#define LIGHT_FIRE 3  // stands for what burns in the volume: a point light, brighter on one side

struct light_entry {
    SHARED_VEC4 position; // xyz: metres; of the sun: unit, towards it; w: radius in metres, of the
                          // sun: sine of its angular radius
    SHARED_VEC4 color; // rgb: radiant intensity (W/sr); of the sun: irradiance at normal incidence
                       // (W/m^2); w: kind
    SHARED_VEC4 axis; // of a spot: xyz: unit, where it shines; w: cosine of the half angle at which
                      // it ends; of fire: xyz: into the direction d its intensity is 1 + dot(axis,
                      // d) times the colour
    SHARED_VEC4 spread; // of a spot: x: cosine of the half angle up to which it is full; of all but
                        // sun and fire: y: range in metres, 0: none; z: 1: falls off linearly
};

// Uniform block "Lights" of every shader that includes lib/light.glsl. The sun is the first.
#define LIGHT_MAX 64
struct light_block {
    SHARED_UVEC4 count; // x: entries in use, at least 1
    SHARED_LIGHT lights[LIGHT_MAX];
};

// Storage buffers of lib/bvh.glsl, whose trees src/scene/bvh.c makes. The first tree is that over
// what is placed; the others are over the triangles of meshes. What is below a node, a word says:
// of a leaf how many triangles, of the first tree placed meshes, << 28 | the first of them; else
// its place among the nodes; 0: there is nothing.
#define BVH_KEPT 48 // a walk of a tree keeps fewer nodes for later
struct bvh_wide {
    SHARED_VEC4 low[3]; // of the boxes of its four children, by axis
    SHARED_VEC4 high[3];
    SHARED_UVEC4 below; // each of them
};

struct bvh_triangle {
    SHARED_VEC4 corner; // xyz: metres, of the mesh itself; w: red of its colour
    SHARED_VEC4 first;  // xyz: edge to the second corner; w: green
    SHARED_VEC4 second; // xyz: edge to the third corner; w: blue
};

struct bvh_instance {
    SHARED_VEC4 inverse[3]; // rows: world to mesh
    SHARED_VEC3 low;        // of its box in the world
    SHARED_UINT below;      // what the root of its tree has below it
    SHARED_VEC3 high;
    SHARED_UINT root;  // of its tree, as the host walks it
    SHARED_VEC4 color; // rgb: factor of the triangles' colours; w: of what they emit
    SHARED_UVEC4 what; // x: the mesh, or the instances that it is one of, as scene_bvh_choose
                       // counts them; y: its number among these; z: first of the materials of its
                       // mesh; w: the mesh, among bvh_levels
};

// How far a mesh may be simplified (lib/level.glsl), the first level in full.
#define DRAWN_LEVELS 4
#define MESH_NO_LEVEL 1e30f // as the error of a level: there is none
// A mesh at all its levels, as rays meet it: storage buffer "BvhLevels" of lib/surface.glsl.
struct bvh_levels {
    SHARED_VEC4 ball;   // around the mesh, in its own space: xyz: metres; w: radius
    SHARED_VEC4 errors; // of each: metres that it is off at most
    SHARED_UVEC4 below; // what the root of the tree of each has below it
};

// One of the instances of meshes that stand in a scene: storage buffer "Instances" of shaders that
// draw them (src/scene/instances.h). Place and turn are in the space of all.
#define INSTANCE_HIDDEN 0xffffffffu
struct instance_entry {
    SHARED_VEC4 place; // xyz: metres; w: scale
    SHARED_VEC4 turn;  // quaternion x, y, z, w
    SHARED_VEC4 color; // rgb: factor of the mesh's colours; w: glow, factor of what it emits
    SHARED_VEC4 state; // numbers of the effect's own
    SHARED_UVEC4 kind; // x: which of the meshes, INSTANCE_HIDDEN: not shown; y: number, from 0; z:
                       // bits of a float in 0..1, its random number
};

// A view that meshes and instances are drawn in, one of those of the storage buffer "Views". The
// host writes it, or a pass that places its views on the device (pass/shadow_maps), so that nothing
// is read back; where in the target it is drawn the host always knows.
struct view_entry {
    SHARED_MAT4 clip; // world to clip; all 0: nothing is drawn in it
    SHARED_VEC4 eye;  // xyz: metres, where distances are counted from; w: pixels of a metre at 1 m,
                      // for levels of detail; 0: all detail
};

// A view of the pass shadow_maps, out of a light.
#define SHADOW_VIEW_VECTORS 6
struct shadow_view {
    SHARED_MAT4 clip;  // world to clip
    SHARED_VEC4 right; // xyz: unit, along rows of texels; w: width of a texel (m): where rays are
                       // parallel, else at 1 m along the axis
    SHARED_VEC4 up;    // xyz: unit, along columns; w: 1 where rays are parallel
};

// One part of a mesh, of all instances that are drawn at once: uniform block "Part" of
// lib/mesh_part.glsl (src/pass/surfaces/drawn.c).
struct drawn_part {
    SHARED_MAT4 place;    // from the space of the instances to the world
    SHARED_VEC4 color;    // base colour, linear, with the factor of all instances; w: alpha
    SHARED_VEC4 surface;  // as of surface_material
    SHARED_VEC4 emission; // the same
    SHARED_UVEC4 flags;   // x: 1 where it is textured; y: the view; z: where the list of its bucket
                          // begins, among those of all (WITHOUT_FIRST_INSTANCE)
};

// A mesh at one of its levels, as shaders/pass/drawn/ choose it; src/pass/surfaces/drawn_cull.c
// writes them.
#define DRAWN_BLOCK 128 // instances whose places in the lists are counted together
#define DRAWN_NONE 0xffffffffu
struct drawn_bucket {
    SHARED_VEC4 sphere; // around the mesh, in the space of an instance: xyz: metres; w: radius
    SHARED_UVEC4 draws; // x: first of its commands; y: how many, 0: the mesh has no such level; z:
                        // bits of a float: metres that it is off at most, MESH_NO_LEVEL where there
                        // is none; w: how far apart they are
};

// What lib/surface.glsl tells of a triangle that was hit; src/scene/surfaces.c makes it.
struct surface_vertex { // as mesh_vertex
    SHARED_VEC4 position_u;
    SHARED_VEC4 normal_v;
};

struct surface_material { // of a part of a mesh
    SHARED_VEC4 color;    // base colour, linear
    SHARED_UVEC4 texture; // width (0: none), height, first of its texels, 1 where it has holes
    SHARED_VEC4 surface;  // specular, roughness, metallic; 1 where toon shading is allowed
    SHARED_VEC4 emission; // rgb: radiance
};

// By what a simulation is spoilt (src/sim/lbm_guard.h): bits.
#define LBM_SPOILT_NUMBERS 1u // moments that are no numbers
#define LBM_SPOILT_MASS 2u
#define LBM_SPOILT_SPEED 4u

// What the shaders of scene/voxels read; src/scene/voxels.c writes it. A part is what of a body is
// voxelised by itself: a run of items (triangles, large ones in strips) with a box of cells.
#define VOXEL_UNIT 256  // steps a cell that corners are rounded to
#define VOXEL_GROUP 64  // threads of a group of those that prepare and cross
#define VOXEL_CLEARED 4 // uvec4s of masks that a thread clears
#define VOXEL_LINES 512 // lines through cells that an item meets, about: larger triangles are cut
#define VOXEL_STRIPS 64 // into so many at most
#define VOXEL_ROW 16    // cells that a thread composes, and side of a tile; a multiple of 4
#define VOXEL_CROSSES                                                                              \
    4096u // flags of an item, above its strip and its strips less one, 6 bits each
#define VOXEL_SHELL 8192u
#define VOXEL_THIN 1.7321 // cells: triangles with more of the body behind them need no shell

struct voxel_head {
    SHARED_UVEC4
    count;             // parts; parts that are voxelised now; groups of prepare.comp, of cross.comp
    SHARED_UVEC4 low;  // xyz: first cell to be composed, x a multiple of VOXEL_ROW
    SHARED_UVEC4 size; // xyz: how many
    SHARED_UVEC4 tiles; // xyz: tiles that these lie in; w: where their lists are
    SHARED_UVEC4 grid;  // xyz: cells of the whole box; w: items of all parts
    SHARED_VEC4 corner; // xyz: metres, of the whole box; w: farthest that a distance can be (m)
    SHARED_VEC4 cell;   // xyz: edges (m)
};

struct voxel_part {
    SHARED_VEC4 rows[3]; // mesh to cells
    SHARED_UVEC4 low;    // xyz: first cell of its box, x a multiple of 4; w: id
    SHARED_UVEC4
    size; // xyz: cells of its box, x a multiple of 4; 0: none; w: 1 where it has a shell
    SHARED_UVEC4 mesh;  // first of its points, how many; first of its items, how many
    SHARED_UVEC4 place; // first of its placed points; its masks (in uvec4) and their size; its
                        // items among those of all parts
    SHARED_VEC4 scale;  // x: cells that a unit of the mesh is long
};

struct voxel_motion {
    SHARED_VEC4 centre;  // xyz: m
    SHARED_VEC4 linear;  // xyz: m/s; w: growth (1/s)
    SHARED_VEC4 angular; // xyz: rad/s
};
