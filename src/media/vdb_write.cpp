// Writes dense grids as sparse ones (vdb.h). Every block of 8^3 voxels becomes a leaf, in parallel;
// empty blocks are dropped. A constant block stays a leaf, which takes almost nothing when
// compressed, because Blender's Cycles takes a grid of tiles for an empty one.
#include "media/vdb_file.hpp"
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include <vector>

using namespace vdb;

namespace {

template <class Grid> struct leaves {
    using tree_type = typename Grid::TreeType;
    using leaf_type = typename tree_type::LeafNodeType;
    using value_type = typename Grid::ValueType;
    static constexpr int side = leaf_type::DIM,
                         components = int(sizeof(value_type) / sizeof(float));

    const vdb_write_grid &from;
    value_type background;
    size_t across[3]; // blocks along each side
    std::vector<std::unique_ptr<leaf_type>> made;

    explicit leaves(const vdb_write_grid &w) : from(w), background(w.background) {
        for (int i = 0; i < 3; i++) across[i] = (w.size[i] + side - 1) / side;
        made.resize(across[0] * across[1] * across[2]);
    }

    float component(size_t voxel, int c) const {
        if (from.halves) return half_to_float(from.halves[voxel * size_t(from.stride) + size_t(c)]);
        return from.values[voxel * size_t(components) + size_t(c)];
    }

    // False when it is as good as the background; what is no number never is.
    bool read(size_t voxel, value_type *out) const {
        float values[components];
        bool active = false;
        for (int c = 0; c < components; c++) {
            values[c] = component(voxel, c);
            active = active || !(std::fabs(values[c] - from.background) <= from.tolerance);
        }
        std::memcpy(out, values, sizeof values);
        return active;
    }

    std::unique_ptr<leaf_type> make(const Coord &corner) const {
        std::unique_ptr<leaf_type> leaf;
        int end[3];
        for (int i = 0; i < 3; i++) end[i] = std::min(corner[i] + side, int(from.size[i]));
        for (int z = corner[2]; z < end[2]; z++)
            for (int y = corner[1]; y < end[1]; y++)
                for (int x = corner[0]; x < end[0]; x++) {
                    size_t row = size_t(z) * from.size[1] + size_t(y);
                    value_type value;
                    if (!read(row * from.size[0] + size_t(x), &value)) continue;
                    if (!leaf) leaf.reset(new leaf_type(corner, background, false));
                    leaf->setValueOn(Coord(x, y, z), value);
                }
        return leaf;
    }

    Coord corner(size_t block) const {
        Coord at(int(block % across[0]), int(block / across[0] % across[1]),
                 int(block / across[0] / across[1]));
        return Coord(at[0] * side, at[1] * side, at[2] * side);
    }

    void make_all() {
        tbb::parallel_for(tbb::blocked_range<size_t>(0, made.size()), [&](const auto &range) {
            for (size_t i = range.begin(); i != range.end(); i++) made[i] = make(corner(i));
        });
    }

    void hand_over(tree_type &tree) {
        for (auto &leaf : made) {
            if (leaf) tree.addLeaf(leaf.release());
        }
    }
};

// The library makes the empty grid: a constructor here would compile all that a grid can do once
// more.
template <class Grid> GridBase::Ptr to_grid(const vdb_write_grid &w) {
    leaves<Grid> all(w);
    GridBase::Ptr grid = GridBase::createGrid(Grid::gridType());
    auto &tree = static_cast<Grid &>(*grid).tree();
    tree.root().setBackground(all.background, false);
    all.make_all();
    all.hand_over(tree);
    return grid;
}

GridBase::Ptr make_grid(const vdb_write_grid &w) {
    static const openvdb::GridClass classes[] = {openvdb::GRID_UNKNOWN, openvdb::GRID_FOG_VOLUME,
                                                 openvdb::GRID_LEVEL_SET, openvdb::GRID_STAGGERED};
    GridBase::Ptr grid;
    if (w.components == 3)
        grid = to_grid<openvdb::Vec3SGrid>(w);
    else
        grid = to_grid<openvdb::FloatGrid>(w);
    auto transform = openvdb::math::Transform::createLinearTransform(double(w.voxel_size));
    transform->postTranslate(Vec3d(w.origin.x, w.origin.y, w.origin.z));
    grid->setTransform(transform);
    grid->setName(w.name);
    grid->setGridClass(classes[w.grid_class]);
    grid->setSaveFloatAsHalf(w.half);
    if (w.turns) grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    return grid;
}

} // namespace

extern "C" bool vdb_encode(const char *name, const vdb_write_grid *grids, size_t count,
                           const vdb_entry *metadata, size_t entries, void **data, size_t *size) {
    return guarded(name, [&] {
        openvdb::GridCPtrVec list;
        for (size_t i = 0; i < count; i++) list.push_back(make_grid(grids[i]));
        openvdb::MetaMap map;
        map.insertMeta("creator", openvdb::StringMetadata("roil " ROIL_VERSION));
        for (size_t i = 0; i < entries; i++)
            if (metadata[i].text)
                map.insertMeta(metadata[i].key, openvdb::StringMetadata(metadata[i].text));
            else
                map.insertMeta(metadata[i].key, openvdb::DoubleMetadata(metadata[i].number));
        std::ostringstream stream(std::ios::binary);
        stream.exceptions(std::ios::failbit | std::ios::badbit);
        archive().write(stream, list, true, map);
        std::string bytes = stream.str();
        *data = mem_copy(bytes.data(), bytes.size());
        *size = bytes.size();
        return true;
    });
}
