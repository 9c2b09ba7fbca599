// A library that makes calls fail, for tests/program/faults.py: preloaded into `roil`, it stands
// between the program and Vulkan and between the program and the heap.
//
//   LD_PRELOAD=libfault.so ROIL_FAULT_FILE=counts ROIL_FAULT="memory 120 once" roil ...
//
// ROIL_FAULT names the class (vulkan: each call that can fail; memory: each allocation), the call
// that fails, counted from 1 or as the first of a name ("vulkan vkWaitSemaphores once"), and
// whether it alone fails (once) or all from it on (always). Without it calls are only counted.
// ROIL_FAULT_FILE is mapped by the program and by all of its children, which count together;
// `struct report` is what it holds.
//
// Calls of a class are many, and most come by a path that another came by, too: a path is the
// functions that lead to a call, from its caller upwards, in a process that was started or in one
// that was forked. With ROIL_FAULT_DEPTH="8,4" (eight functions in `roil`, four in the programs
// that it starts) the report lists them, each with its first call's number, and "memory @9a3f once"
// makes the first call that comes by the path of that name fail. It is the same in each run.
//
// Of allocations those count that the program's own code asks for, and those of the libraries whose
// names contain one of the words in ROIL_FAULT_LIBRARIES (separated by commas). A driver's and the
// loader's do not: they end the process as they like.
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

// glibc's own names of these, which nothing stands before.
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t align, size_t size);

typedef enum fault_class { VULKAN, MEMORY, CLASSES } fault_class;
// OWN_FRAMES: path_of, fails, and the function that stands in for the call
enum { OWN_FRAMES = 3 };
enum { NAME_CAP = 64, TEXT_CAP = 512, MOST_RANGES = 64, MOST_DEPTH = 32, MOST_PATHS = 1 << 17 };

struct path {
    _Atomic uint64_t name; // 0: none
    uint64_t class, number;
};

struct report {
    _Atomic uint64_t calls[CLASSES], failed, after; // after: of the class, since the first failure
    uint64_t place;      // of the caller of the first that failed, in its program or library
    uint64_t exited;     // roil ended by exit(), which runs the handlers of libraries
    char name[NAME_CAP]; // of the call
    struct path paths[MOST_PATHS];
};

static struct {
    struct report *report; // NULL: nothing is counted, nothing fails
    fault_class class;
    uint64_t number, path; // 0: none of them fails
    char name[NAME_CAP];
    bool always;
    int depth;   // of a path; 0: none is looked for
    pid_t begun; // the process that was started
    bool other;  // not roil
} plan;

// ---- whose calls ------------------------------------------------------------------------------

static struct {
    uintptr_t base, begin, end;
} ranges[MOST_RANGES]; // code whose allocations count; the program's first
static size_t range_count;

static bool is_named(const char *library) {
    const char *wanted = getenv("ROIL_FAULT_LIBRARIES");
    char words[TEXT_CAP], *rest;
    if (!wanted || !library[0]) return false;
    snprintf(words, sizeof words, "%s", wanted);
    for (char *word = strtok_r(words, ",", &rest); word; word = strtok_r(NULL, ",", &rest))
        if (strstr(library, word)) return true;
    return false;
}

static int note_ranges(struct dl_phdr_info *info, size_t size, void *user) {
    bool *program = user; // comes first
    (void)size;
    bool counts = *program || is_named(info->dlpi_name);
    *program = false;
    for (int i = 0; counts && i < info->dlpi_phnum && range_count < MOST_RANGES; i++) {
        const ElfW(Phdr) *part = &info->dlpi_phdr[i];
        if (part->p_type != PT_LOAD || !(part->p_flags & PF_X)) continue;
        ranges[range_count].base = info->dlpi_addr;
        ranges[range_count].begin = info->dlpi_addr + part->p_vaddr;
        ranges[range_count].end = info->dlpi_addr + part->p_vaddr + part->p_memsz;
        range_count++;
    }
    return 0;
}

static bool find_range(const void *caller, uint64_t *place) {
    for (size_t i = 0; i < range_count; i++) {
        if ((uintptr_t)caller < ranges[i].begin || (uintptr_t)caller >= ranges[i].end) continue;
        *place = (uintptr_t)caller - ranges[i].base;
        return true;
    }
    return false;
}

// ---- paths ------------------------------------------------------------------------------------

// By where each function lies in its program or library, and in the last two bits by the process:
// 1 for one that was forked, 2 for another program than roil. `own`: frames of this file.
static __attribute__((noinline)) uint64_t path_of(fault_class class, int own) {
    void *frames[MOST_DEPTH];
    int count = backtrace(frames, own + plan.depth);
    uint64_t name = class + 1;
    for (int i = own; i < count; i++) {
        struct dl_find_object found;
        uintptr_t base = _dl_find_object(frames[i], &found) == 0 ? found.dlfo_link_map->l_addr : 0;
        name = (name ^ ((uintptr_t)frames[i] - base)) * UINT64_C(0x9e3779b97f4a7c15);
        name ^= name >> 29;
    }
    return (name << 3) | 4 | (plan.other ? 2 : 0) | (getpid() != plan.begun);
}

static void note_path(uint64_t name, fault_class class, uint64_t number) {
    for (uint64_t i = 0; i < MOST_PATHS; i++) {
        struct path *p = &plan.report->paths[(name + i) % MOST_PATHS];
        uint64_t none = 0;
        if (atomic_compare_exchange_strong(&p->name, &none, name)) {
            p->class = class;
            p->number = number;
            return;
        }
        if (none == name) return;
    }
}

// ---- the plan ---------------------------------------------------------------------------------

static void refuse(const char *what) {
    fprintf(stderr, "fault.c: %s\n", what);
    _exit(99);
}

__attribute__((constructor)) static void begin(void) {
    const char *path = getenv("ROIL_FAULT_FILE"), *fault = getenv("ROIL_FAULT");
    const char *depth = getenv("ROIL_FAULT_DEPTH");
    if (!path) return;
    char class[16], how[16];
    if (depth) {
        int depths[2];
        if (sscanf(depth, "%d,%d", &depths[0], &depths[1]) != 2) refuse("ROIL_FAULT_DEPTH");
        plan.other = strcmp(program_invocation_short_name, "roil") != 0;
        plan.depth = depths[plan.other];
        if (plan.depth < 1 || plan.depth > MOST_DEPTH - OWN_FRAMES) refuse("ROIL_FAULT_DEPTH");
        plan.begun = getpid();
        backtrace(&(void *){NULL}, 1); // loads what it needs
    }
    if (fault) {
        if (sscanf(fault, "%15s %lu %15s", class, &plan.number, how) != 3 &&
            (sscanf(fault, "%15s @%lx %15s", class, &plan.path, how) != 3 || !plan.depth) &&
            sscanf(fault, "%15s %63[a-zA-Z0-9_] %15s", class, plan.name, how) != 3)
            refuse("ROIL_FAULT: CLASS NUMBER|@PATH|NAME once|always is accepted");
        plan.class = strcmp(class, "memory") == 0 ? MEMORY : VULKAN;
        plan.always = strcmp(how, "always") == 0;
    }
    bool program = true;
    dl_iterate_phdr(note_ranges, &program);
    int fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (fd < 0 || ftruncate(fd, sizeof *plan.report) != 0) refuse(path);
    long map =
        syscall(SYS_mmap, NULL, sizeof *plan.report, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0L);
    if (map == -1) refuse(path);
    close(fd);
    plan.report = (struct report *)map;
}

__attribute__((destructor)) static void end(void) {
    if (plan.report && strcmp(program_invocation_short_name, "roil") == 0) plan.report->exited = 1;
}

static __attribute__((noinline)) bool fails(fault_class class, const char *name,
                                            const void *caller) {
    uint64_t place, path = 0;
    if (!plan.report || !find_range(caller, &place)) return false;
    uint64_t number = atomic_fetch_add(&plan.report->calls[class], 1) + 1;
    bool wanted = class == plan.class && (plan.number || plan.path || plan.name[0]);
    if (wanted && atomic_load(&plan.report->failed)) {
        atomic_fetch_add(&plan.report->after, 1);
        if (!plan.always) return false;
        atomic_fetch_add(&plan.report->failed, 1);
        return true;
    }
    if (plan.depth && (plan.path ? wanted : !plan.number)) path = path_of(class, OWN_FRAMES);
    if (path && !plan.path) note_path(path, class, number);
    if (!wanted || (plan.path      ? path != plan.path
                    : plan.name[0] ? strcmp(name, plan.name) != 0
                                   : number != plan.number))
        return false;
    if (atomic_fetch_add(&plan.report->failed, 1) > 0) return plan.always; // another was faster
    plan.report->place = place;
    snprintf(plan.report->name, NAME_CAP, "%s", name);
    return true;
}

#define FAILS(class) fails(class, __func__, __builtin_return_address(0))

// ---- the heap ---------------------------------------------------------------------------------

static void *no_memory(void) {
    errno = ENOMEM;
    return NULL;
}

void *malloc(size_t size) {
    return FAILS(MEMORY) ? no_memory() : __libc_malloc(size);
}

void *calloc(size_t count, size_t size) {
    return FAILS(MEMORY) ? no_memory() : __libc_calloc(count, size);
}

void *realloc(void *block, size_t size) {
    return FAILS(MEMORY) ? no_memory() : __libc_realloc(block, size);
}

void *aligned_alloc(size_t align, size_t size) {
    return FAILS(MEMORY) ? no_memory() : __libc_memalign(align, size);
}

int posix_memalign(void **out, size_t align, size_t size) {
    if (FAILS(MEMORY)) return ENOMEM;
    *out = __libc_memalign(align, size);
    return *out ? 0 : ENOMEM;
}

void *mmap(void *at, size_t size, int protection, int flags, int fd, off_t offset) {
    if (FAILS(MEMORY)) {
        errno = ENOMEM;
        return MAP_FAILED;
    }
    return (void *)syscall(SYS_mmap, at, size, protection, flags, fd, offset);
}

// operator new: asked for more than there is, the real one throws std::bad_alloc for us.
#define OPERATOR_NEW(name)                                                                         \
    void *name(size_t size);                                                                       \
    void *name(size_t size) {                                                                      \
        void *(*real)(size_t) = (void *(*)(size_t))dlsym(RTLD_NEXT, #name);                        \
        return real(FAILS(MEMORY) ? PTRDIFF_MAX : size);                                           \
    }
OPERATOR_NEW(_Znwm)
OPERATOR_NEW(_Znam)

// ---- Vulkan -----------------------------------------------------------------------------------

// A call that may find the device lost does so at every second number; all others lack memory.
// What a lost device was doing has ended, one way or the other: so it is waited for first.
#define LOSES(wait) (plan.number % 2 ? (wait, VK_ERROR_DEVICE_LOST) : VK_ERROR_OUT_OF_DEVICE_MEMORY)
#define LOSES_DEVICE LOSES(wait_for_device(device))
#define LACKS (plan.number % 2 ? VK_ERROR_OUT_OF_HOST_MEMORY : VK_ERROR_OUT_OF_DEVICE_MEMORY)

static void wait_for_device(VkDevice device) {
    ((PFN_vkDeviceWaitIdle)dlsym(RTLD_NEXT, "vkDeviceWaitIdle"))(device);
}

static void wait_for_queue(VkQueue queue) {
    ((PFN_vkQueueWaitIdle)dlsym(RTLD_NEXT, "vkQueueWaitIdle"))(queue);
}

#define CALL(name, failure, parameters, arguments)                                                 \
    VKAPI_ATTR VkResult VKAPI_CALL name parameters {                                               \
        PFN_##name real = (PFN_##name)dlsym(RTLD_NEXT, #name);                                     \
        return FAILS(VULKAN) ? failure : real arguments;                                           \
    }
#define CREATE(object)                                                                             \
    CALL(vkCreate##object, LACKS,                                                                  \
         (VkDevice device, const Vk##object##CreateInfo *info, const VkAllocationCallbacks *heap,  \
          Vk##object *out),                                                                        \
         (device, info, heap, out))
#define CREATE_PIPELINES(kind)                                                                     \
    CALL(vkCreate##kind##Pipelines, LACKS,                                                         \
         (VkDevice device, VkPipelineCache cache, uint32_t count,                                  \
          const Vk##kind##PipelineCreateInfo *infos, const VkAllocationCallbacks *heap,            \
          VkPipeline *out),                                                                        \
         (device, cache, count, infos, heap, out))

CALL(vkCreateInstance, LACKS,
     (const VkInstanceCreateInfo *info, const VkAllocationCallbacks *heap, VkInstance *out),
     (info, heap, out))
CALL(vkEnumerateInstanceVersion, LACKS, (uint32_t * out), (out))
CALL(vkEnumerateInstanceLayerProperties, LACKS, (uint32_t * count, VkLayerProperties *out),
     (count, out))
CALL(vkEnumerateInstanceExtensionProperties, LACKS,
     (const char *layer, uint32_t *count, VkExtensionProperties *out), (layer, count, out))
CALL(vkEnumeratePhysicalDevices, LACKS,
     (VkInstance instance, uint32_t *count, VkPhysicalDevice *out), (instance, count, out))
CALL(vkEnumerateDeviceExtensionProperties, LACKS,
     (VkPhysicalDevice physical, const char *layer, uint32_t *count, VkExtensionProperties *out),
     (physical, layer, count, out))
CALL(vkGetPhysicalDeviceImageFormatProperties, LACKS,
     (VkPhysicalDevice physical, VkFormat format, VkImageType type, VkImageTiling tiling,
      VkImageUsageFlags usage, VkImageCreateFlags flags, VkImageFormatProperties *out),
     (physical, format, type, tiling, usage, flags, out))
CALL(vkCreateDevice, LOSES((void)0),
     (VkPhysicalDevice physical, const VkDeviceCreateInfo *info, const VkAllocationCallbacks *heap,
      VkDevice *out),
     (physical, info, heap, out))
CREATE(Semaphore)
CREATE(CommandPool)
CREATE(DescriptorPool)
CREATE(DescriptorSetLayout)
CREATE(DescriptorUpdateTemplate)
CREATE(PipelineLayout)
CREATE(PipelineCache)
CREATE(ShaderModule)
CREATE(Sampler)
CREATE(QueryPool)
CREATE(Event)
CREATE(Buffer)
CREATE(Image)
CREATE(ImageView)
CREATE_PIPELINES(Compute)
CREATE_PIPELINES(Graphics)
CALL(vkAllocateMemory, LACKS,
     (VkDevice device, const VkMemoryAllocateInfo *info, const VkAllocationCallbacks *heap,
      VkDeviceMemory *out),
     (device, info, heap, out))
CALL(vkMapMemory, LACKS,
     (VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
      VkMemoryMapFlags flags, void **out),
     (device, memory, offset, size, flags, out))
CALL(vkBindBufferMemory, LACKS,
     (VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset),
     (device, buffer, memory, offset))
CALL(vkBindImageMemory, LACKS,
     (VkDevice device, VkImage image, VkDeviceMemory memory, VkDeviceSize offset),
     (device, image, memory, offset))
CALL(vkAllocateCommandBuffers, LACKS,
     (VkDevice device, const VkCommandBufferAllocateInfo *info, VkCommandBuffer *out),
     (device, info, out))
CALL(vkAllocateDescriptorSets, LACKS,
     (VkDevice device, const VkDescriptorSetAllocateInfo *info, VkDescriptorSet *out),
     (device, info, out))
CALL(vkResetCommandPool, LACKS,
     (VkDevice device, VkCommandPool pool, VkCommandPoolResetFlags flags), (device, pool, flags))
CALL(vkBeginCommandBuffer, LACKS, (VkCommandBuffer commands, const VkCommandBufferBeginInfo *info),
     (commands, info))
CALL(vkEndCommandBuffer, LACKS, (VkCommandBuffer commands), (commands))
CALL(vkQueueSubmit2, LOSES(wait_for_queue(queue)),
     (VkQueue queue, uint32_t count, const VkSubmitInfo2 *infos, VkFence fence),
     (queue, count, infos, fence))
CALL(vkWaitSemaphores, LOSES_DEVICE,
     (VkDevice device, const VkSemaphoreWaitInfo *info, uint64_t timeout), (device, info, timeout))
CALL(vkGetSemaphoreCounterValue, LOSES_DEVICE,
     (VkDevice device, VkSemaphore semaphore, uint64_t *out), (device, semaphore, out))
CALL(vkDeviceWaitIdle, LOSES_DEVICE, (VkDevice device), (device))
CALL(vkGetEventStatus, LOSES_DEVICE, (VkDevice device, VkEvent event), (device, event))
CALL(vkResetEvent, LACKS, (VkDevice device, VkEvent event), (device, event))
CALL(vkGetQueryPoolResults, LOSES_DEVICE,
     (VkDevice device, VkQueryPool pool, uint32_t first, uint32_t count, size_t size, void *out,
      VkDeviceSize stride, VkQueryResultFlags flags),
     (device, pool, first, count, size, out, stride, flags))
CALL(vkGetPipelineCacheData, LACKS,
     (VkDevice device, VkPipelineCache cache, size_t *size, void *out), (device, cache, size, out))

// Calls are asked for by name: those above stand in for the loader's there, too.
static PFN_vkVoidFunction stand_in(PFN_vkVoidFunction found, const char *name) {
    PFN_vkVoidFunction own = found ? (PFN_vkVoidFunction)dlsym(RTLD_DEFAULT, name) : NULL;
    return own ? own : found;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance,
                                                               const char *name) {
    PFN_vkGetInstanceProcAddr real =
        (PFN_vkGetInstanceProcAddr)dlsym(RTLD_NEXT, "vkGetInstanceProcAddr");
    return stand_in(real(instance, name), name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetDeviceProcAddr(VkDevice device, const char *name) {
    PFN_vkGetDeviceProcAddr real = (PFN_vkGetDeviceProcAddr)dlsym(RTLD_NEXT, "vkGetDeviceProcAddr");
    return stand_in(real(device, name), name);
}
