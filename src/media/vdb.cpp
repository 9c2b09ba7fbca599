// OpenVDB behind vdb_decode.h: metadata and dense sampling. vdb_blocks.cpp reads grids that stay
// sparse, vdb_write.cpp writes files.
//
// Sampling: when the voxel centres of the box lie on the grid's own lattice, values are copied node
// by node (openvdb::tools::copyToDense: tiles, background and leaves). Else every centre is
// transformed by the inverse of the grid's affine transform, and interpolated between 8 voxels.
// Index coordinates are voxel centres, so voxel i covers i - 0.5 to i + 0.5. Staggered vectors are
// located on voxel faces, half a voxel below the centre on their own axis.
#include "media/vdb_file.hpp"
#include <openvdb/tools/Dense.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>

using namespace vdb;

namespace {

// Reads the extent of a grid whose metadata lack it. It is called from C, so no exception may leave
// it.
bool read_extent(const vdb_layout *l, const vdb_layout_grid *g, vdb_grid_info *out) {
    return guarded(l->path, [&] {
        GridBase::Ptr grid;
        if (!load(*l, *g, &grid)) return false;
        CoordBBox box = grid->evalActiveVoxelBoundingBox();
        for (int i = 0; i < 3; i++) {
            out->index_min[i] = box.min()[i];
            out->index_max[i] = box.max()[i];
        }
        out->active_voxels = grid->activeVoxelCount();
        return true;
    });
}

template <class Tree>
void fill(const Tree &tree, const placing &place, const vdb_sample_desc &desc, bool staggered) {
    using result = typename sample_type<typename Tree::ValueType>::type;
    auto out = reinterpret_cast<result *>(desc.out);
    if (!staggered && place.on_lattice()) {
        Coord lo = place.origin();
        Coord hi = lo + Coord(int(desc.size[0]) - 1, int(desc.size[1]) - 1, int(desc.size[2]) - 1);
        openvdb::tools::Dense<result, openvdb::tools::LayoutXYZ> target(CoordBBox(lo, hi), out);
        openvdb::tools::copyToDense(tree, target);
        return;
    }
    auto layers = [&](const tbb::blocked_range<uint32_t> &range) {
        interpolator<Tree> value(tree, staggered);
        for (uint32_t z = range.begin(); z != range.end(); z++)
            for (uint32_t y = 0; y < desc.size[1]; y++) {
                result *row = out + (size_t(z) * desc.size[1] + y) * desc.size[0];
                Vec3d start = place.first + place.step[1] * double(y) + place.step[2] * double(z);
                for (uint32_t x = 0; x < desc.size[0]; x++)
                    row[x] = value(start + place.step[0] * double(x));
            }
    };
    tbb::parallel_for(tbb::blocked_range<uint32_t>(0, desc.size[2]), layers);
}

template <class Grid>
bool sample(const GridBase &base, const affine &t, const vdb_sample_desc &desc, vdb_class cls) {
    const Grid &grid = static_cast<const Grid &>(base);
    bool staggered = cls == VDB_STAGGERED && desc.components == 3;
    placing place(t, desc);
    if (!place.is_near())
        return err_set("%s: grid '%s': the box to sample is too far away or not finite", desc.path,
                       desc.grid);
    fill(grid.tree(), place, desc, staggered);
    if (cls == VDB_LEVEL_SET && desc.components == 1) {
        fog value(grid, t, desc.level_set);
        size_t count = size_t(desc.size[0]) * desc.size[1] * desc.size[2];
        for (size_t i = 0; i < count; i++) desc.out[i] = value(desc.out[i]);
    }
    return true;
}

// Nearly all blocks have no fault and need only this check. It tests bits, so that the loop is
// vectorised.
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
    return vdb::with_type(value, [&](auto *type) {
        return sample<std::remove_pointer_t<decltype(type)>>(grid, t, d, cls);
    });
}

bool size_is_fine(const vdb_sample_desc &desc) {
    uint64_t voxels = 1;
    for (int i = 0; i < 3; i++) {
        if (desc.size[i] == 0 || voxels > sample_voxels_max / desc.size[i])
            return err_set("%s: cannot resample to %ux%ux%u voxels; 1 to 2^31 are accepted",
                           desc.path, desc.size[0], desc.size[1], desc.size[2]);
        voxels *= desc.size[i];
    }
    return true;
}

} // namespace

extern "C" void vdb_work_alone() {
    static tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
    initialize();
}

extern "C" vdb_file *vdb_file_open(const char *name, const void *bytes, size_t size) {
    std::unique_ptr<vdb_file> made;
    bool done = guarded(name, [&] {
        made = std::make_unique<vdb_file>();
        return vdb_layout_read(name, bytes, size, &made->contents.memory, &made->contents.layout);
    });
    return done ? made.release() : nullptr;
}

extern "C" void vdb_file_close(vdb_file *f) {
    delete f;
}

extern "C" bool vdb_file_info(const vdb_file *opened, arena *memory, vdb_info *out) {
    const vdb_layout &l = opened->contents.layout;
    return guarded(l.path, [&] {
        if (!vdb_describe(&l, read_extent, memory, out)) return false;
        openvdb::MetaMap map = read_metadata(l, l.metadata, l.size);
        std::string text;
        for (auto it = map.beginMeta(); it != map.endMeta(); ++it)
            text += it->first + " = " + it->second->str() + "\n";
        out->metadata = arena_string(memory, text.c_str());
        return true;
    });
}

extern "C" bool vdb_file_sample(const vdb_file *opened, const vdb_sample_desc *desc,
                                uint64_t *bad) {
    const file &f = opened->contents;
    if (bad) *bad = 0;
    return guarded(desc->path, [&] {
        const vdb_layout_grid *g = f.find(desc->grid);
        if (!g) return no_such_grid(f, *desc);
        if (!can_sample(*g, *desc) || !size_is_fine(*desc)) return false;
        affine transform;
        GridBase::Ptr grid;
        if (!read_affine(f.layout, *g, &transform) || !load(f.layout, *g, &grid)) return false;
        vdb_class cls = vdb_class_read(&f.layout, g);
        if (!sample_any(*grid, g->value, transform, *desc, cls)) return false;
        size_t voxels = size_t(desc->size[0]) * desc->size[1] * desc->size[2];
        uint64_t cleared = clear_bad(desc->out, voxels * size_t(desc->components));
        if (bad) *bad = cleared;
        return true;
    });
}
