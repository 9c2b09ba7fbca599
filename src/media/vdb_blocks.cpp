// Reads a grid in blocks (vdb_decode.h). On the lattice of the grid a block is copied from the at
// most eight leaves and tiles that it touches. Elsewhere its voxels are interpolated as by
// vdb_sample.
//
// Only nodes with values other than the background are reported. When an unusual transform makes
// their boxes overlap so much that visiting them would take longer than reading everything, the
// whole box is reported instead.
#include "media/vdb_file.hpp"

#include <algorithm>
#include <memory>

using namespace vdb;

namespace {

constexpr int side = VDB_BLOCK, owned = VDB_BLOCK - 1, leaf_side = 8;
constexpr double report_most = 64.0; // times the voxels of the box

struct box {
    int32_t low[3], high[3]; // inclusive
};

} // namespace

struct vdb_blocks {
    virtual ~vdb_blocks() = default;
    virtual void visit(vdb_block_found *found, void *user) const = 0;
    virtual uint64_t read(const int32_t at[3], float *out) = 0;
    virtual void background(float out[3]) const = 0;
};

namespace {

// Maps index coordinates to voxels of the box: the inverse of a placement.
class from_index {
  public:
    explicit from_index(const placing &p) : first_(p.first) {
        double volume = p.step[0].dot(p.step[1].cross(p.step[2]));
        for (int i = 0; i < 3; i++)
            rows_[i] = p.step[(i + 1) % 3].cross(p.step[(i + 2) % 3]) / volume;
    }
    // All voxels that values in `index` can reach.
    box operator()(const openvdb::BBoxd &index) const {
        box out;
        for (int i = 0; i < 3; i++) {
            double low = 1e300, high = -1e300;
            for (int corner = 0; corner < 8; corner++) {
                Vec3d p;
                for (int k = 0; k < 3; k++)
                    p[k] = corner >> k & 1 ? index.max()[k] : index.min()[k];
                double at = rows_[i].dot(p - first_);
                low = std::min(low, at);
                high = std::max(high, at);
            }
            out.low[i] = int32_t(std::max(-1e9, std::min(1e9, std::floor(low))));
            out.high[i] = int32_t(std::max(-1e9, std::min(1e9, std::ceil(high))));
        }
        return out;
    }

  private:
    Vec3d first_, rows_[3];
};

template <class Grid> class blocks : public vdb_blocks {
  public:
    using tree = typename Grid::TreeType;
    using leaf = typename tree::LeafNodeType;
    using value = typename tree::ValueType;
    using result = typename sample_type<value>::type;

    blocks(GridBase::Ptr grid, const affine &t, const vdb_sample_desc &desc, vdb_class cls)
        : grid_(openvdb::gridPtrCast<Grid>(grid)), place_(t, desc), access_(grid_->tree()),
          staggered_(cls == VDB_STAGGERED && desc.components == 3),
          interpolated_(grid_->tree(), staggered_), exact_(!staggered_ && place_.on_lattice()),
          foggy_(cls == VDB_LEVEL_SET && desc.components == 1), fog_(*grid_, t, desc.level_set) {
        if (exact_) origin_ = place_.origin();
    }
    bool is_near() const { return place_.is_near(); }

    void visit(vdb_block_found *found, void *user) const override {
        from_index place(place_);
        double budget = report_most;
        for (int i = 0; i < 3; i++) budget *= place_.size[i];
        auto report = [&](const CoordBBox &nodes) {
            double reach = exact_ ? 0.0 : staggered_ ? 2.0 : 1.0;
            box b =
                place(openvdb::BBoxd(nodes.min().asVec3d() - reach, nodes.max().asVec3d() + reach));
            if (exact_)
                for (int i = 0; i < 3; i++) {
                    b.low[i] = nodes.min()[i] - origin_[i];
                    b.high[i] = nodes.max()[i] - origin_[i];
                }
            double voxels = 1.0;
            for (int i = 0; i < 3; i++) {
                b.low[i] = std::max(b.low[i], 0);
                b.high[i] = std::min(b.high[i], int32_t(place_.size[i]) - 1);
                voxels *= std::max(0.0, double(b.high[i]) - b.low[i] + 1.0);
            }
            if (voxels > 0.0) found(user, b.low, b.high);
            budget -= voxels;
            return budget > 0.0;
        };
        if (visit_tiles(report) && visit_leaves(report)) return;
        const int32_t low[3] = {0, 0, 0};
        int32_t high[3];
        for (int i = 0; i < 3; i++) high[i] = int32_t(place_.size[i]) - 1;
        found(user, low, high);
    }

    uint64_t read(const int32_t at[3], float *out) override {
        auto values = reinterpret_cast<result *>(out);
        if (exact_)
            copy(Coord(at[0], at[1], at[2]) + origin_, values);
        else
            interpolate(at, values);
        constexpr int count = side * side * side * int(sizeof(result) / sizeof(float));
        if (foggy_)
            for (int i = 0; i < count; i++) out[i] = fog_(out[i]);
        bool fine = true;
        for (int i = 0; i < count; i++) fine = fine && std::isfinite(out[i]);
        return fine ? 0 : clear(out);
    }

    void background(float out[3]) const override {
        result v(grid_->background());
        std::memcpy(out, &v, sizeof v);
        if (foggy_) out[0] = fog_(out[0]);
        for (size_t i = 0; i < sizeof v / sizeof *out; i++)
            if (!std::isfinite(out[i])) out[i] = 0.0f;
    }

  private:
    template <class Report> bool visit_tiles(Report report) const {
        auto it = grid_->tree().cbeginValueAll();
        it.setMaxDepth(decltype(it)::LEAF_DEPTH - 1);
        for (; it; ++it) {
            if (*it == grid_->background()) continue;
            CoordBBox nodes;
            it.getBoundingBox(nodes);
            if (!report(nodes)) return false;
        }
        return true;
    }
    template <class Report> bool visit_leaves(Report report) const {
        const value nothing = grid_->background();
        for (auto it = grid_->tree().cbeginLeaf(); it; ++it) {
            bool same = true;
            for (openvdb::Index i = 0; i < leaf::SIZE && same; i++)
                same = value_of(*it, i) == nothing;
            if (!same && !report(it->getNodeBoundingBox())) return false;
        }
        return true;
    }

    static value value_of(const leaf &l, openvdb::Index i) {
        if constexpr (std::is_same<value, bool>::value)
            return l.getValue(i);
        else
            return l.buffer().data()[i];
    }

    // The part of the block from `at` on that lies in the leaf or tile that holds `cell`.
    void copy_cell(const Coord &at, const Coord &cell, const int low[3], const int high[3],
                   result *out) {
        const leaf *l = access_.probeConstLeaf(cell);
        result constant = l ? result(0.0f) : result(access_.getValue(cell));
        for (int x = low[0]; x < high[0]; x++)
            for (int y = low[1]; y < high[1]; y++) {
                result *to = out + y * side + x;
                if (!l) {
                    for (int z = low[2]; z < high[2]; z++) to[z * side * side] = constant;
                    continue;
                }
                // z varies fastest, and no part of a block crosses the end of a leaf.
                openvdb::Index from = leaf::coordToOffset(at + Coord(x, y, low[2]));
                for (int z = low[2]; z < high[2]; z++)
                    to[z * side * side] = result(value_of(*l, from + openvdb::Index(z - low[2])));
            }
    }

    void copy(const Coord &at, result *out) {
        int ends[3][4]; // of the parts along each axis
        int parts[3];
        for (int i = 0; i < 3; i++) {
            int count = 0;
            ends[i][count++] = 0;
            int first = leaf_side - (at[i] & (leaf_side - 1));
            for (int end = first; end < side; end += leaf_side) ends[i][count++] = end;
            ends[i][count] = side;
            parts[i] = count;
        }
        for (int z = 0; z < parts[2]; z++)
            for (int y = 0; y < parts[1]; y++)
                for (int x = 0; x < parts[0]; x++) {
                    const int low[3] = {ends[0][x], ends[1][y], ends[2][z]};
                    const int high[3] = {ends[0][x + 1], ends[1][y + 1], ends[2][z + 1]};
                    copy_cell(at, at + Coord(low[0], low[1], low[2]), low, high, out);
                }
    }

    void interpolate(const int32_t at[3], result *out) {
        for (int z = 0; z < side; z++)
            for (int y = 0; y < side; y++) {
                Vec3d start = place_.first + place_.step[1] * double(at[1] + y) +
                              place_.step[2] * double(at[2] + z);
                for (int x = 0; x < side; x++)
                    *out++ = interpolated_(start + place_.step[0] * double(at[0] + x));
            }
    }

    static uint64_t clear(float *out) {
        constexpr int width = int(sizeof(result) / sizeof(float));
        uint64_t bad = 0;
        for (int z = 0; z < side; z++)
            for (int y = 0; y < side; y++)
                for (int x = 0; x < side; x++)
                    for (int i = 0; i < width; i++, out++) {
                        if (std::isfinite(*out)) continue;
                        *out = 0.0f;
                        if (x < owned && y < owned && z < owned) bad++;
                    }
        return bad;
    }

    typename Grid::Ptr grid_;
    placing place_;
    openvdb::tree::ValueAccessor<const tree> access_;
    bool staggered_;
    interpolator<tree> interpolated_;
    bool exact_;
    Coord origin_;
    bool foggy_;
    fog fog_;
};

template <class Grid>
vdb_blocks *make(GridBase::Ptr grid, const affine &t, const vdb_sample_desc &desc, vdb_class cls) {
    auto b = std::make_unique<blocks<Grid>>(grid, t, desc, cls);
    if (b->is_near()) return b.release();
    err_set("%s: grid '%s': the box to sample is too far away or not finite", desc.path, desc.grid);
    return nullptr;
}

vdb_blocks *make_any(GridBase::Ptr grid, vdb_value value, const affine &t,
                     const vdb_sample_desc &desc, vdb_class cls) {
    return vdb::with_type(value, [&](auto *type) {
        return make<std::remove_pointer_t<decltype(type)>>(grid, t, desc, cls);
    });
}

} // namespace

extern "C" vdb_blocks *vdb_blocks_open(const vdb_file *opened, const vdb_sample_desc *desc) {
    vdb_blocks *made = nullptr;
    const file &f = opened->contents;
    guarded(desc->path, [&] {
        const vdb_layout_grid *g = f.find(desc->grid);
        if (!g) return no_such_grid(f, *desc);
        affine transform;
        GridBase::Ptr grid;
        if (!can_sample(*g, *desc) || !read_affine(f.layout, *g, &transform) ||
            !load(f.layout, *g, &grid))
            return false;
        vdb_class cls = vdb_class_read(&f.layout, g);
        made = make_any(grid, g->value, transform, *desc, cls);
        return made != nullptr;
    });
    return made;
}

extern "C" void vdb_blocks_visit(const vdb_blocks *b, vdb_block_found *found, void *user) {
    b->visit(found, user);
}

extern "C" uint64_t vdb_blocks_read(vdb_blocks *b, const int32_t at[3], float *out) {
    return b->read(at, out);
}

extern "C" void vdb_blocks_background(const vdb_blocks *b, float out[3]) {
    b->background(out);
}

extern "C" void vdb_blocks_close(vdb_blocks *b) {
    delete b;
}
