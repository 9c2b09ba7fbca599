// OpenVDB behind vdb.h, the only C++ of the program. The file is read into memory, its structure is
// proved by vdb_layout.c, and only then does OpenVDB parse the one grid that is wanted.
//
// Sampling: when the voxel centres of the box lie on the grid's own lattice, values are copied node
// by node (openvdb::tools::copyToDense: tiles, background and leaves); else every centre goes
// through the inverse of the grid's affine transform and is interpolated between 8 voxels. Index
// coordinates name voxel centres, so voxel i covers i - 0.5 to i + 0.5. Staggered vectors sit on
// voxel faces, half a voxel below the centre on their own axis.
#ifndef NDEBUG
#define NDEBUG // OpenVDB's asserts are no checks of files, and would end the program
#endif
#include <cglm/cglm.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/DelayedLoadMetadata.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#define _Noreturn [[noreturn]] // as C++ spells it
extern "C" {
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "media/vdb.h"
#include "media/vdb_layout.h"
// LeakSanitizer's, absent in other builds.
__attribute__((weak)) void __lsan_disable(void);
__attribute__((weak)) void __lsan_enable(void);
}
#undef _Noreturn

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::GridBase;
using openvdb::Vec3d;
using openvdb::Vec3s;

constexpr size_t file_bytes_max = size_t(2) << 30;
constexpr int coord_max = 1 << 24;
constexpr double box_voxels_max = 68719476736.0; // 4096^3
constexpr size_t sample_voxels_max = size_t(1) << 31;

void initialize() {
    static const bool once = [] {
        openvdb::initialize();
        // Compressed side tables for delayed loading, which we do not use: read as plain bytes.
        openvdb::io::DelayedLoadMetadata::unregisterType();
        return true;
    }();
    (void)once;
}

// Every entry point runs inside this: no exception reaches C.
template <class Work> bool guarded(const char *path, Work work) {
    try {
        initialize();
        return work();
    } catch (const std::bad_alloc &) {
        return err_set("%s: not enough memory for this VDB file", path);
    } catch (const std::exception &e) {
        return err_set("%s: OpenVDB: %s", path, e.what());
    } catch (...) {
        return err_set("%s: OpenVDB: unknown fault", path);
    }
}

class buffer : public std::streambuf {
  public:
    buffer(const uint8_t *bytes, size_t size) {
        char *p = const_cast<char *>(reinterpret_cast<const char *>(bytes));
        setg(p, p, p + size);
    }

  protected:
    pos_type seekoff(off_type by, std::ios_base::seekdir from, std::ios_base::openmode) override {
        off_type base = from == std::ios_base::beg   ? 0
                        : from == std::ios_base::cur ? gptr() - eback()
                                                     : egptr() - eback();
        if (base + by < 0 || base + by > egptr() - eback()) return pos_type(off_type(-1));
        setg(eback(), eback() + base + by, egptr());
        return pos_type(base + by);
    }
    pos_type seekpos(pos_type at, std::ios_base::openmode mode) override {
        return seekoff(off_type(at), std::ios_base::beg, mode);
    }
};

struct archive : openvdb::io::Archive { // opens what the library keeps to its own readers
    using Archive::readGrid;
    using Archive::write;
};

// A VDB file in memory whose structure is known to be sound.
struct file {
    arena memory = {};
    void *bytes = nullptr;
    vdb_layout layout = {};

    file() = default;
    file(const file &) = delete;
    ~file() {
        arena_free(&memory);
        mem_free(bytes);
    }
    bool open(const char *path) {
        size_t size;
        return file_read(path, file_bytes_max, &bytes, &size) &&
               vdb_layout_read(path, bytes, size, &memory, &layout);
    }
    const vdb_layout_grid *find(const char *name) const {
        for (size_t i = 0; i < layout.count; i++)
            if (strcmp(layout.grids[i].name, name) == 0) return &layout.grids[i];
        return nullptr;
    }
};

struct input { // a stream over part of a file, as OpenVDB's readers expect it
    buffer bytes;
    std::istream stream;
    input(const vdb_layout &l, size_t start, size_t end) : bytes(l.bytes, end), stream(&bytes) {
        stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
        stream.seekg(std::streamoff(start));
        openvdb::io::setVersion(stream, {l.library_major, l.library_minor}, l.version);
        openvdb::io::setDataCompression(stream, openvdb::io::COMPRESS_NONE);
    }
};

openvdb::MetaMap read_metadata(const vdb_layout &l, size_t start, size_t end) {
    input in(l, start, end);
    openvdb::MetaMap map;
    map.readMeta(in.stream);
    return map;
}

// When a compressed block is broken OpenVDB throws with nodes half set up, whose destructor would
// free pointers that were never set. Such a tree is left behind for good, knowingly.
GridBase::Ptr read_tree(const vdb_layout &l, const vdb_layout_grid &g) {
    struct leak_scope {
        leak_scope() {
            if (__lsan_disable) __lsan_disable();
        }
        ~leak_scope() {
            if (__lsan_enable) __lsan_enable();
        }
    } scope;
    auto kept = new GridBase::Ptr(GridBase::createGrid(g.tree_type));
    (*kept)->setSaveFloatAsHalf(g.half);
    input in(l, g.start, g.end);
    openvdb::io::GridDescriptor descriptor(g.unique, g.tree_type, g.half);
    archive::readGrid(*kept, descriptor, in.stream);
    GridBase::Ptr grid = *kept;
    delete kept;
    return grid;
}

// The grid whose tree holds the voxels of `g`: itself, or the one it shares them with.
const vdb_layout_grid *tree_owner(const vdb_layout &l, const vdb_layout_grid &g) {
    if (g.parent[0] == '\0') return &g;
    for (size_t i = 0; i < l.count; i++)
        if (strcmp(l.grids[i].unique, g.parent) == 0 && l.grids[i].parent[0] == '\0' &&
            l.grids[i].value == g.value && l.grids[i].linear)
            return &l.grids[i];
    err_set("%s: damaged VDB file: grid '%s' shares the voxels of a grid '%s' that is not there",
            l.path, g.name, g.parent);
    return nullptr;
}

bool load(const vdb_layout &l, const vdb_layout_grid &g, GridBase::Ptr *out) {
    const vdb_layout_grid *owner = tree_owner(l, g);
    if (!owner || !vdb_layout_check_tree(&l, owner)) return false;
    *out = read_tree(l, *owner);
    return true;
}

// index = inverse * (world - origin); world = origin + axis * index.
struct affine {
    Vec3d origin, axis[3];
    Vec3d inverse[3]; // rows
    Vec3d to_world(const Vec3d &i) const {
        return origin + axis[0] * i[0] + axis[1] * i[1] + axis[2] * i[2];
    }
    Vec3d to_index(const Vec3d &world) const {
        Vec3d p = world - origin;
        return Vec3d(inverse[0].dot(p), inverse[1].dot(p), inverse[2].dot(p));
    }
};

bool read_affine(const vdb_layout &l, const vdb_layout_grid &g, affine *out) {
    input in(l, g.transform, g.end);
    openvdb::math::Transform transform;
    transform.read(in.stream);
    out->origin = transform.indexToWorld(Vec3d(0.0));
    for (int i = 0; i < 3; i++) {
        Vec3d unit(0.0);
        unit[i] = 1.0;
        out->axis[i] = transform.indexToWorld(unit) - out->origin;
    }
    const Vec3d *a = out->axis;
    double volume = a[0].dot(a[1].cross(a[2]));
    double size = a[0].length() * a[1].length() * a[2].length();
    if (!std::isfinite(volume) || !std::isfinite(out->origin.lengthSqr()) || !(size > 1e-30) ||
        size > 1e30 || std::fabs(volume) < 1e-9 * size)
        return err_set("%s: grid '%s': the transform is singular or not finite", l.path, g.name);
    for (int i = 0; i < 3; i++) out->inverse[i] = a[(i + 1) % 3].cross(a[(i + 2) % 3]) / volume;
    return true;
}

bool is_axis_aligned(const affine &t) {
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (i != k && std::fabs(t.axis[i][k]) > 1e-9 * t.axis[i].length()) return false;
    return true;
}

// World box of an inclusive index box, with the outer halves of its border voxels.
box3 world_box(const affine &t, const int32_t min[3], const int32_t max[3]) {
    Vec3d lo(1e300), hi(-1e300);
    for (int corner = 0; corner < 8; corner++) {
        Vec3d index;
        for (int i = 0; i < 3; i++) index[i] = corner >> i & 1 ? max[i] + 0.5 : min[i] - 0.5;
        Vec3d world = t.to_world(index);
        lo = openvdb::math::minComponent(lo, world);
        hi = openvdb::math::maxComponent(hi, world);
    }
    return {{float(lo[0]), float(lo[1]), float(lo[2])}, {float(hi[0]), float(hi[1]), float(hi[2])}};
}

vdb_class class_of(const openvdb::MetaMap &map) {
    std::string text;
    if (auto value = map.getMetadata<openvdb::StringMetadata>(GridBase::META_GRID_CLASS))
        text = value->value();
    switch (GridBase::stringToGridClass(text)) {
    case openvdb::GRID_FOG_VOLUME:
        return VDB_FOG;
    case openvdb::GRID_LEVEL_SET:
        return VDB_LEVEL_SET;
    case openvdb::GRID_STAGGERED:
        return VDB_STAGGERED;
    default:
        return VDB_UNKNOWN;
    }
}

// The background stands at the front of the tree, after a 32-bit count.
void read_background(const vdb_layout &l, const vdb_layout_grid &g, float out[3]) {
    const uint8_t *p = l.bytes + g.tree + sizeof(int32_t);
    if (g.value == VDB_VALUE_OTHER || g.end - g.tree < sizeof(int32_t) + vdb_value_size(g.value))
        return;
    auto fill = [&](auto zero) {
        for (int i = 0; i < vdb_value_components(g.value); i++) {
            std::memcpy(&zero, p + size_t(i) * sizeof zero, sizeof zero);
            out[i] = float(zero);
        }
    };
    switch (g.value) {
    case VDB_VALUE_FLOAT:
    case VDB_VALUE_VEC3S:
        return fill(float());
    case VDB_VALUE_DOUBLE:
    case VDB_VALUE_VEC3D:
        return fill(double());
    case VDB_VALUE_INT32:
    case VDB_VALUE_VEC3I:
        return fill(int32_t());
    case VDB_VALUE_INT64:
        return fill(int64_t());
    case VDB_VALUE_BOOL:
        return fill(uint8_t());
    case VDB_VALUE_OTHER:
        return;
    }
}

// Active box and count from the metadata, else from the voxels.
bool read_extent(const vdb_layout &l, const vdb_layout_grid &g, const openvdb::MetaMap &map,
                 vdb_grid_info *out) {
    auto min = map.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MIN);
    auto max = map.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MAX);
    auto count = map.getMetadata<openvdb::Int64Metadata>(GridBase::META_FILE_VOXEL_COUNT);
    CoordBBox box;
    if (min && max) {
        box = CoordBBox(Coord(min->value()), Coord(max->value()));
        out->active_voxels = count && count->value() > 0 ? uint64_t(count->value()) : 0;
    } else if (g.value != VDB_VALUE_OTHER && g.linear) {
        GridBase::Ptr grid;
        if (!load(l, g, &grid)) return false;
        box = grid->evalActiveVoxelBoundingBox();
        out->active_voxels = grid->activeVoxelCount();
    }
    bool empty = false;
    double voxels = 1.0;
    for (int i = 0; i < 3; i++) {
        empty = empty || box.min()[i] > box.max()[i];
        voxels *= double(box.max()[i]) - box.min()[i] + 1.0;
    }
    for (int i = 0; i < 3; i++) {
        out->index_min[i] = empty ? 0 : box.min()[i];
        out->index_max[i] = empty ? -1 : box.max()[i];
        if (out->index_min[i] < -coord_max || out->index_max[i] > coord_max)
            return err_set("%s: grid '%s': absurd active box, index %d to %d; +-%d is accepted",
                           l.path, g.name, out->index_min[i], out->index_max[i], coord_max);
    }
    if (!empty && voxels > box_voxels_max)
        return err_set(
            "%s: grid '%s': absurd active box of %.3g voxels; at most 4096^3 is accepted", l.path,
            g.name, voxels);
    return true;
}

bool describe(const vdb_layout &l, const vdb_layout_grid &g, arena *memory, vdb_grid_info *out) {
    openvdb::MetaMap map = read_metadata(l, g.metadata, g.end);
    out->name = arena_string(memory, g.name);
    out->type = arena_string(memory, g.half && g.value == VDB_VALUE_FLOAT ? "half" : g.type);
    out->components = vdb_value_components(g.value);
    out->grid_class = class_of(map);
    out->saved_half = g.half;
    out->linear = g.linear;
    out->box = box3_empty();
    if (!read_extent(l, g, map, out)) return false;
    if (!g.linear) return true;
    affine t;
    if (!read_affine(l, g, &t)) return false;
    for (int i = 0; i < 3; i++) out->voxel_size[i] = float(t.axis[i].length());
    out->axis_aligned = is_axis_aligned(t);
    const vdb_layout_grid *owner = tree_owner(l, g);
    if (!owner) return false;
    read_background(l, *owner, out->background);
    if (out->index_min[0] <= out->index_max[0])
        out->box = world_box(t, out->index_min, out->index_max);
    return true;
}

template <class Value> struct sample_type { using type = float; };
template <class Real> struct sample_type<openvdb::math::Vec3<Real>> { using type = Vec3s; };

template <class Tree> class sampler {
  public:
    using value = typename Tree::ValueType;
    using result = typename sample_type<value>::type;

    sampler(const Tree &tree, const affine &transform, const vdb_sample_desc &desc, bool staggered)
        : tree_(tree), desc_(desc), staggered_(staggered) {
        const float3 &lo = desc.box.min, &hi = desc.box.max;
        Vec3d size(double(hi.x) - lo.x, double(hi.y) - lo.y, double(hi.z) - lo.z);
        Vec3d step;
        for (int i = 0; i < 3; i++) step[i] = size[i] / desc.size[i];
        first_ = transform.to_index(Vec3d(lo.x, lo.y, lo.z) + step * 0.5);
        for (int i = 0; i < 3; i++) {
            Vec3d along(0.0);
            along[i] = step[i];
            step_[i] = transform.to_index(transform.origin + along);
        }
    }

    // False when the box is so far away that index coordinates would overflow.
    bool is_near() const {
        double reach = 0.0;
        for (int i = 0; i < 3; i++) {
            reach += std::fabs(first_[i]);
            for (int k = 0; k < 3; k++) reach += std::fabs(step_[i][k]) * desc_.size[i];
        }
        return reach < 1e9; // NaN is not near
    }

    void run() {
        if (on_lattice()) {
            Coord lo(int(std::lround(first_[0])), int(std::lround(first_[1])),
                     int(std::lround(first_[2])));
            Coord hi =
                lo + Coord(int(desc_.size[0]) - 1, int(desc_.size[1]) - 1, int(desc_.size[2]) - 1);
            using dense = openvdb::tools::Dense<result, openvdb::tools::LayoutXYZ>;
            dense target(CoordBBox(lo, hi), out());
            openvdb::tools::copyToDense(tree_, target);
        } else {
            tbb::parallel_for(tbb::blocked_range<uint32_t>(0, desc_.size[2]),
                              [&](const tbb::blocked_range<uint32_t> &z) { interpolate(z); });
        }
    }

  private:
    result *out() const { return reinterpret_cast<result *>(desc_.out); }

    // Centres on voxel centres and one voxel apart, to a hundredth of a voxel over the whole box.
    bool on_lattice() const {
        if (staggered_) return false;
        for (int i = 0; i < 3; i++) {
            if (std::fabs(first_[i] - std::round(first_[i])) > 0.01) return false;
            for (int k = 0; k < 3; k++)
                if (std::fabs(step_[i][k] - (i == k ? 1.0 : 0.0)) * desc_.size[i] > 0.01)
                    return false;
        }
        return true;
    }

    template <class Access> result at(Access &access, const Vec3d &p) const {
        Coord cell(int(std::floor(p[0])), int(std::floor(p[1])), int(std::floor(p[2])));
        float f[3];
        for (int i = 0; i < 3; i++) f[i] = float(p[i] - cell[i]);
        result sum(0.0f);
        for (int corner = 0; corner < 8; corner++) {
            float weight = 1.0f;
            for (int i = 0; i < 3; i++) weight *= corner >> i & 1 ? f[i] : 1.0f - f[i];
            if (weight == 0.0f) continue; // a NaN next door does not count
            Coord c = cell.offsetBy(corner & 1, corner >> 1 & 1, corner >> 2);
            sum += result(access.getValue(c)) * weight;
        }
        return sum;
    }

    template <class Access> float face(Access &access, Vec3d p, int axis, float) const {
        (void)axis;
        return at(access, p);
    }
    template <class Access> Vec3s face(Access &access, Vec3d p, int axis, Vec3s sum) const {
        p[axis] += 0.5;
        sum[axis] = at(access, p)[axis];
        return sum;
    }

    void interpolate(const tbb::blocked_range<uint32_t> &layers) const {
        openvdb::tree::ValueAccessor<const Tree> access(tree_);
        for (uint32_t z = layers.begin(); z != layers.end(); z++)
            for (uint32_t y = 0; y < desc_.size[1]; y++) {
                result *row = out() + (size_t(z) * desc_.size[1] + y) * desc_.size[0];
                Vec3d start = first_ + step_[1] * double(y) + step_[2] * double(z);
                for (uint32_t x = 0; x < desc_.size[0]; x++) {
                    Vec3d p = start + step_[0] * double(x);
                    if (!staggered_) {
                        row[x] = at(access, p);
                        continue;
                    }
                    result sum(0.0f);
                    for (int axis = 0; axis < 3; axis++) sum = face(access, p, axis, sum);
                    row[x] = sum;
                }
            }
    }

    const Tree &tree_;
    const vdb_sample_desc &desc_;
    bool staggered_;
    Vec3d first_, step_[3]; // index coordinates of centre 0; from one centre to the next
};

template <class Value> float first_component(const Value &v) {
    return float(v);
}
template <class Real> float first_component(const openvdb::math::Vec3<Real> &v) {
    return float(v[0]);
}

template <class Grid>
bool sample(const GridBase &base, const affine &t, const vdb_sample_desc &desc, vdb_class cls) {
    const Grid &grid = static_cast<const Grid &>(base);
    bool staggered = cls == VDB_STAGGERED && desc.components == 3;
    sampler<typename Grid::TreeType> s(grid.tree(), t, desc, staggered);
    if (!s.is_near())
        return err_set("%s: grid '%s': the box to sample is too far away or not finite", desc.path,
                       desc.grid);
    s.run();
    if (cls == VDB_LEVEL_SET && desc.components == 1) {
        float band = std::fabs(first_component(grid.background()));
        if (!(band > 0.0f)) band = 3.0f * float(t.axis[0].length());
        size_t count = size_t(desc.size[0]) * desc.size[1] * desc.size[2];
        for (size_t i = 0; i < count; i++) {
            float d = desc.out[i];
            desc.out[i] = d <= 0.0f ? 1.0f : d >= band ? 0.0f : 1.0f - d / band;
        }
    }
    return true;
}

// Blocks without a fault, nearly all, are only looked at: bits, so that the loop is vectorised.
bool has_bad(const float *values) {
    uint32_t bad = 0;
    for (size_t i = 0; i < 1024; i++) {
        uint32_t bits;
        std::memcpy(&bits, values + i, sizeof bits);
        bad |= (bits & 0x7f800000u) == 0x7f800000u ? 1u : 0u;
    }
    return bad != 0;
}

uint64_t clear_bad(float *values, size_t count) {
    uint64_t bad = 0;
    for (size_t start = 0; start < count; start += 1024) {
        size_t end = std::min(count, start + 1024);
        if (end - start == 1024 && !has_bad(values + start)) continue;
        for (size_t i = start; i < end; i++)
            if (!std::isfinite(values[i])) {
                values[i] = 0.0f;
                bad++;
            }
    }
    return bad;
}

bool sample_any(const GridBase &grid, vdb_value value, const affine &t, const vdb_sample_desc &d,
                vdb_class cls) {
    switch (value) {
    case VDB_VALUE_FLOAT:
        return sample<openvdb::FloatGrid>(grid, t, d, cls);
    case VDB_VALUE_DOUBLE:
        return sample<openvdb::DoubleGrid>(grid, t, d, cls);
    case VDB_VALUE_INT32:
        return sample<openvdb::Int32Grid>(grid, t, d, cls);
    case VDB_VALUE_INT64:
        return sample<openvdb::Int64Grid>(grid, t, d, cls);
    case VDB_VALUE_BOOL:
        return sample<openvdb::BoolGrid>(grid, t, d, cls);
    case VDB_VALUE_VEC3S:
        return sample<openvdb::Vec3SGrid>(grid, t, d, cls);
    case VDB_VALUE_VEC3D:
        return sample<openvdb::Vec3DGrid>(grid, t, d, cls);
    case VDB_VALUE_VEC3I:
        return sample<openvdb::Vec3IGrid>(grid, t, d, cls);
    case VDB_VALUE_OTHER:
        break;
    }
    return false;
}

// Names all grids of the file.
bool no_such_grid(const file &f, const vdb_sample_desc &desc) {
    std::string names;
    for (size_t i = 0; i < f.layout.count && names.size() < 400; i++)
        names += (i ? ", " : "") + std::string(f.layout.grids[i].name);
    return err_set("%s: no grid named '%s'; the file has: %s", desc.path, desc.grid,
                   names.empty() ? "none" : names.c_str());
}

bool can_sample(const vdb_layout_grid &g, const vdb_sample_desc &desc) {
    if (g.value == VDB_VALUE_OTHER)
        return err_set("%s: grid '%s' has values of type %s; float, half, double, int32, int64, "
                       "bool, vec3s, vec3d and vec3i are read",
                       desc.path, desc.grid, g.type);
    if (!g.linear)
        return err_set("%s: grid '%s' has a frustum transform; resample it to boxes of voxels "
                       "first",
                       desc.path, desc.grid);
    if (vdb_value_components(g.value) != desc.components)
        return err_set("%s: grid '%s' has %d component(s) a voxel, not %d", desc.path, desc.grid,
                       vdb_value_components(g.value), desc.components);
    uint64_t voxels = 1;
    for (int i = 0; i < 3; i++) {
        if (desc.size[i] == 0 || voxels > sample_voxels_max / desc.size[i])
            return err_set("%s: cannot resample to %ux%ux%u voxels; 1 to 2^31 are accepted",
                           desc.path, desc.size[0], desc.size[1], desc.size[2]);
        voxels *= desc.size[i];
    }
    return true;
}

template <class Grid>
GridBase::Ptr dense_to_grid(const vdb_write_grid &w, typename Grid::ValueType background) {
    using value = typename Grid::ValueType;
    auto grid = Grid::create(background);
    CoordBBox box(Coord(0), Coord(int(w.size[0]) - 1, int(w.size[1]) - 1, int(w.size[2]) - 1));
    auto values = reinterpret_cast<value *>(const_cast<float *>(w.values));
    openvdb::tools::Dense<value, openvdb::tools::LayoutXYZ> dense(box, values);
    openvdb::tools::copyFromDense(dense, *grid, value(0.0f));
    // OpenVDB finds NaN equal to the background.
    auto access = grid->getAccessor();
    for (auto it = box.begin(); it; ++it) {
        value v = dense.getValue(*it);
        if (!openvdb::math::isFinite(v)) access.setValueOn(*it, v);
    }
    return grid;
}

GridBase::Ptr make_grid(const vdb_write_grid &w) {
    static const openvdb::GridClass classes[] = {openvdb::GRID_UNKNOWN, openvdb::GRID_FOG_VOLUME,
                                                 openvdb::GRID_LEVEL_SET, openvdb::GRID_STAGGERED};
    GridBase::Ptr grid = w.components == 3
                             ? dense_to_grid<openvdb::Vec3SGrid>(w, Vec3s(w.background))
                             : dense_to_grid<openvdb::FloatGrid>(w, w.background);
    auto transform = openvdb::math::Transform::createLinearTransform(double(w.voxel_size));
    transform->postTranslate(Vec3d(w.origin.x, w.origin.y, w.origin.z));
    grid->setTransform(transform);
    grid->setName(w.name);
    grid->setGridClass(classes[w.grid_class]);
    grid->setSaveFloatAsHalf(w.half);
    return grid;
}

} // namespace

extern "C" bool vdb_read_info(const char *path, arena *memory, vdb_info *out) {
    return guarded(path, [&] {
        file f;
        if (!f.open(path)) return false;
        size_t count = f.layout.count;
        auto grids = static_cast<vdb_grid_info *>(arena_alloc(memory, count * sizeof *out->grids));
        for (size_t i = 0; i < count; i++)
            if (!describe(f.layout, f.layout.grids[i], memory, &grids[i])) return false;
        openvdb::MetaMap map = read_metadata(f.layout, f.layout.metadata, f.layout.size);
        std::string text;
        for (auto it = map.beginMeta(); it != map.endMeta(); ++it)
            text += it->first + " = " + it->second->str() + "\n";
        *out = {grids, count, arena_string(memory, text.c_str())};
        return true;
    });
}

extern "C" bool vdb_sample(const vdb_sample_desc *desc, uint64_t *bad) {
    if (bad) *bad = 0;
    return guarded(desc->path, [&] {
        file f;
        if (!f.open(desc->path)) return false;
        const vdb_layout_grid *g = f.find(desc->grid);
        if (!g) return no_such_grid(f, *desc);
        if (!can_sample(*g, *desc)) return false;
        affine transform;
        GridBase::Ptr grid;
        if (!read_affine(f.layout, *g, &transform) || !load(f.layout, *g, &grid)) return false;
        vdb_class cls = class_of(read_metadata(f.layout, g->metadata, g->end));
        if (!sample_any(*grid, g->value, transform, *desc, cls)) return false;
        size_t voxels = size_t(desc->size[0]) * desc->size[1] * desc->size[2];
        uint64_t cleared = clear_bad(desc->out, voxels * size_t(desc->components));
        if (bad) *bad = cleared;
        return true;
    });
}

extern "C" bool vdb_write(const char *path, const vdb_write_grid *grids, size_t count) {
    return guarded(path, [&] {
        openvdb::GridCPtrVec list;
        for (size_t i = 0; i < count; i++) list.push_back(make_grid(grids[i]));
        openvdb::MetaMap metadata;
        metadata.insertMeta("creator", openvdb::StringMetadata("roil"));
        std::ostringstream stream(std::ios::binary);
        stream.exceptions(std::ios::failbit | std::ios::badbit);
        archive().write(stream, list, true, metadata);
        std::string bytes = stream.str();
        return file_write(path, bytes.data(), bytes.size());
    });
}
