// Threads of the stages that have one for each particle or each splat, and of the scan, which is one
// group.
#if defined(STAGE_PROJECT) || defined(STAGE_LIST) || defined(STAGE_SCAN)
const uint SCANNERS = 256u;
layout(local_size_x = SCANNERS) in;

uint group_of_thread() {
    return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

uint slot_of_thread() {
    return SCANNERS * group_of_thread() + gl_LocalInvocationIndex;
}
#endif

#if defined(STAGE_SCAN) || (defined(STAGE_LIST) && BLEND == BLEND_SORTED)
shared uint scan_sums[SCANNERS];

// Sum of what the threads of the group before this one have.
uint scan_before(uint own) {
    uint thread = gl_LocalInvocationIndex;
    scan_sums[thread] = own;
    for (uint step = 1u; step < SCANNERS; step *= 2u) {
        barrier();
        uint other = thread >= step ? scan_sums[thread - step] : 0u;
        barrier();
        scan_sums[thread] += other;
    }
    return scan_sums[thread] - own;
}
#endif
