// Shared by the files that use OpenVDB: the structure of a file in memory is proved by
// vdb_layout.c, and only then does OpenVDB parse the one grid that is wanted. And where the voxels
// of a box lie among those of a grid.
#pragma once
#ifndef NDEBUG
#define NDEBUG // OpenVDB's asserts are no checks of files, and would end the program
#endif
#include <cglm/cglm.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/DelayedLoadMetadata.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <cstring>
#include <string>
#define _Noreturn [[noreturn]] // as C++ spells it
extern "C" {
#include "base/error.h"
#include "base/memory.h"
#include "media/vdb_decode.h"
#include "media/vdb_describe.h"
// LeakSanitizer's, absent in other builds.
__attribute__((weak)) void __lsan_disable(void);
__attribute__((weak)) void __lsan_enable(void);
}
#undef _Noreturn

namespace vdb {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::GridBase;
using openvdb::Vec3d;
using openvdb::Vec3s;

constexpr size_t sample_voxels_max = size_t(1) << 31;

inline void initialize() {
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
    vdb_layout layout = {};

    file() = default;
    file(const file &) = delete;
    ~file() { arena_free(&memory); }
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

inline openvdb::MetaMap read_metadata(const vdb_layout &l, size_t start, size_t end) {
    input in(l, start, end);
    openvdb::MetaMap map;
    map.readMeta(in.stream);
    return map;
}

// When a compressed block is broken OpenVDB throws with nodes half set up, whose destructor would
// free pointers that were never set. Such a tree is left behind for good, knowingly.
inline GridBase::Ptr read_tree(const vdb_layout &l, const vdb_layout_grid &g) {
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

inline bool load(const vdb_layout &l, const vdb_layout_grid &g, GridBase::Ptr *out) {
    const vdb_layout_grid *owner = vdb_tree_owner(&l, &g);
    if (!owner || !vdb_layout_check_tree(&l, owner, nullptr)) return false;
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

inline bool read_affine(const vdb_layout &l, const vdb_layout_grid &g, affine *out) {
    vdb_affine t;
    if (!vdb_affine_read(&l, &g, &t)) return false;
    out->origin = Vec3d(t.origin);
    for (int i = 0; i < 3; i++) out->axis[i] = Vec3d(t.axis[i]);
    const Vec3d *a = out->axis;
    double volume = a[0].dot(a[1].cross(a[2]));
    for (int i = 0; i < 3; i++) out->inverse[i] = a[(i + 1) % 3].cross(a[(i + 2) % 3]) / volume;
    return true;
}

// Where the voxel centres of a box lie in a grid's index space: at first + step[i] * voxel[i].
struct placing {
    Vec3d first, step[3];
    uint32_t size[3];

    placing(const affine &transform, const vdb_sample_desc &desc) {
        const float3 &lo = desc.box.min, &hi = desc.box.max;
        Vec3d all(double(hi.x) - lo.x, double(hi.y) - lo.y, double(hi.z) - lo.z), voxel;
        for (int i = 0; i < 3; i++) {
            size[i] = desc.size[i];
            voxel[i] = all[i] / size[i];
        }
        first = transform.to_index(Vec3d(lo.x, lo.y, lo.z) + voxel * 0.5);
        for (int i = 0; i < 3; i++) {
            Vec3d along(0.0);
            along[i] = voxel[i];
            step[i] = transform.to_index(transform.origin + along);
        }
    }

    // False when the box is so far away that index coordinates would overflow.
    bool is_near() const {
        double reach = 0.0;
        for (int i = 0; i < 3; i++) {
            reach += std::fabs(first[i]);
            for (int k = 0; k < 3; k++) reach += std::fabs(step[i][k]) * size[i];
        }
        return reach < 1e9; // NaN is not near
    }

    // Centres on voxel centres and one voxel apart, to a hundredth of a voxel over the whole box.
    bool on_lattice() const {
        for (int i = 0; i < 3; i++) {
            if (std::fabs(first[i] - std::round(first[i])) > 0.01) return false;
            for (int k = 0; k < 3; k++)
                if (std::fabs(step[i][k] - (i == k ? 1.0 : 0.0)) * size[i] > 0.01) return false;
        }
        return true;
    }
    Coord origin() const { // of a box on the lattice
        return Coord(int(std::lround(first[0])), int(std::lround(first[1])),
                     int(std::lround(first[2])));
    }
};

template <class Value> struct sample_type { using type = float; };
template <class Real> struct sample_type<openvdb::math::Vec3<Real>> { using type = Vec3s; };

// Values between voxel centres, interpolated between 8 voxels; one accessor for one thread.
template <class Tree> class interpolator {
  public:
    using result = typename sample_type<typename Tree::ValueType>::type;

    interpolator(const Tree &tree, bool staggered) : access_(tree), staggered_(staggered) {}

    result operator()(const Vec3d &p) {
        if (!staggered_) return at(p);
        result sum(0.0f);
        for (int axis = 0; axis < 3; axis++) face(p, axis, sum);
        return sum;
    }

  private:
    result at(const Vec3d &p) {
        Coord cell(int(std::floor(p[0])), int(std::floor(p[1])), int(std::floor(p[2])));
        float f[3];
        for (int i = 0; i < 3; i++) f[i] = float(p[i] - cell[i]);
        result sum(0.0f);
        for (int corner = 0; corner < 8; corner++) {
            float weight = 1.0f;
            for (int i = 0; i < 3; i++) weight *= corner >> i & 1 ? f[i] : 1.0f - f[i];
            if (weight == 0.0f) continue; // a NaN next door does not count
            Coord c = cell.offsetBy(corner & 1, corner >> 1 & 1, corner >> 2);
            sum += result(access_.getValue(c)) * weight;
        }
        return sum;
    }
    void face(const Vec3d &p, int, float &sum) { sum = at(p); }
    void face(Vec3d p, int axis, Vec3s &sum) {
        p[axis] += 0.5;
        sum[axis] = at(p)[axis];
    }

    openvdb::tree::ValueAccessor<const Tree> access_;
    bool staggered_;
};

template <class Value> float first_component(const Value &v) {
    return float(v);
}
template <class Real> float first_component(const openvdb::math::Vec3<Real> &v) {
    return float(v[0]);
}

// Distances of a level set, negative inside, as what fills it (vdb_set).
struct fog {
    float band, full; // width of a half of the narrow band; distance of the value 1
    template <class Grid>
    fog(const Grid &grid, const affine &t, vdb_set set)
        : band(std::fabs(first_component(grid.background()))) {
        if (!(band > 0.0f)) band = 3.0f * float(t.axis[0].length());
        full = set == VDB_SET_FOG ? -band : 0.0f;
    }
    float operator()(float d) const {
        d -= full;
        return d <= 0.0f ? 1.0f : d >= band ? 0.0f : 1.0f - d / band;
    }
};

// Names all grids of the file.
inline bool no_such_grid(const file &f, const vdb_sample_desc &desc) {
    std::string names;
    for (size_t i = 0; i < f.layout.count && names.size() < 400; i++)
        names += (i ? ", " : "") + std::string(f.layout.grids[i].name);
    return err_set("%s: no grid named '%s'; the file has: %s", desc.path, desc.grid,
                   names.empty() ? "none" : names.c_str());
}

inline bool can_sample(const vdb_layout_grid &g, const vdb_sample_desc &desc) {
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
    return true;
}

// Calls `f` with a null pointer to the type of grids of these values; else returns a zero.
template <typename F>
auto with_type(vdb_value value, F f) -> decltype(f(static_cast<openvdb::FloatGrid *>(nullptr))) {
    switch (value) {
    case VDB_VALUE_FLOAT:
        return f(static_cast<openvdb::FloatGrid *>(nullptr));
    case VDB_VALUE_DOUBLE:
        return f(static_cast<openvdb::DoubleGrid *>(nullptr));
    case VDB_VALUE_INT32:
        return f(static_cast<openvdb::Int32Grid *>(nullptr));
    case VDB_VALUE_INT64:
        return f(static_cast<openvdb::Int64Grid *>(nullptr));
    case VDB_VALUE_BOOL:
        return f(static_cast<openvdb::BoolGrid *>(nullptr));
    case VDB_VALUE_VEC3S:
        return f(static_cast<openvdb::Vec3SGrid *>(nullptr));
    case VDB_VALUE_VEC3D:
        return f(static_cast<openvdb::Vec3DGrid *>(nullptr));
    case VDB_VALUE_VEC3I:
        return f(static_cast<openvdb::Vec3IGrid *>(nullptr));
    case VDB_VALUE_OTHER:
        break;
    }
    return {};
}

} // namespace vdb

struct vdb_file {
    vdb::file contents;
};
