-- SPDX-License-Identifier: MIT
-- springstep for LuaJIT: the declarations of its C headers, under the same names, as far as main.lua uses them.
--
--     local spring = require "springstep"
--     spring.spring_scene_advance(scene, spring.SPRING_LEAPFROG, dt, n)
--
-- The shared library is the file that the variable SPRINGSTEP_LIBRARY names; or it lies beside the game; or it is
-- installed.
local ffi = require "ffi"

ffi.cdef [[
typedef enum spring_method {
    SPRING_EULER, SPRING_LEAPFROG, SPRING_RK4, SPRING_EXACT, SPRING_SYMPLECTIC_EULER, SPRING_RKN8
} spring_method;
typedef enum spring_status {
    SPRING_OK, SPRING_EINVAL, SPRING_ENONFINITE, SPRING_ENOMEM, SPRING_EALIGN, SPRING_ERANGE, SPRING_EUNSUPPORTED,
    SPRING_EDISABLED, SPRING_EROUNDING, SPRING_EFLUSHED, SPRING_EFUSED, SPRING_EBITS
} spring_status;
const char *spring_status_string(spring_status s);
const char *spring_version(void);

typedef struct spring_clock { double pending, dropped; } spring_clock;
uint64_t spring_clock_tick(spring_clock *clock, double frame_dt, double dt, uint64_t max_steps, double *alpha);

enum { SPRING_SCENE_ALIGN = 64, SPRING_SCENE_EDITABLE = 1, SPRING_GRID_STRUCTURAL = 1, SPRING_GRID_FIRST_X = 1 };
typedef enum spring_quantity { SPRING_POSITION, SPRING_VELOCITY } spring_quantity;
typedef struct spring_link { uint32_t a, b; double rest, stiffness, damping; } spring_link;
typedef void spring_scene_force_fn(void *user, double t, size_t particles, const double *const position[3],
                                   const double *const velocity[3], double *const force[3]);
typedef struct spring_scene_def {
    uint32_t axes, flags, methods;
    size_t particles, links;
    const double *position, *velocity, *mass;
    double mass_all;
    const uint8_t *pinned;
    const spring_link *link;
    double gravity[3], drag;
    spring_scene_force_fn *force;
    void *user;
} spring_scene_def;
typedef struct spring_scene spring_scene;
spring_status spring_scene_bytes(const spring_scene_def *def, size_t *bytes);
spring_status spring_scene_init(void *memory, size_t bytes, const spring_scene_def *def, spring_scene **scene);
spring_status spring_scene_advance(spring_scene *s, spring_method m, double dt, uint64_t n);
double spring_scene_stable_step(spring_scene *s, spring_method m);
spring_status spring_scene_get(const spring_scene *s, spring_quantity q, double *out, size_t stride, size_t first,
                               size_t count);
spring_status spring_scene_set_link(spring_scene *s, size_t index, const spring_link *link);
spring_status spring_scene_get_link(const spring_scene *s, size_t index, spring_link *link);
spring_status spring_scene_drive(spring_scene *s, size_t particle, const double *target, double duration);

typedef struct spring_grid {
    uint32_t count[3], axes;
    bool height;
    double spacing, stretch;
    uint32_t families;
    double stiffness, damping;
    uint32_t pinned;
} spring_grid;
spring_status spring_grid_fill(const spring_grid *g, double *position, uint8_t *pinned, spring_link *link);
]]

local function file_name()
  return ({Windows = "libspringstep-0.dll", OSX = "libspringstep.0.dylib"})[ffi.os] or "libspringstep.so.0"
end

-- Beside the game: in its folder, or in that of its .love file.
local function beside_the_game()
  local folders = {love.filesystem.getSource(), love.filesystem.getSourceBaseDirectory()}
  for i, folder in ipairs(folders) do
    folders[i] = folder .. "/" .. file_name()
  end
  return folders
end

local function load_library()
  local named = os.getenv("SPRINGSTEP_LIBRARY")
  local places = named and {named} or beside_the_game()
  if not named then
    places[#places + 1] = file_name()
  end
  local failures = {}
  for _, place in ipairs(places) do
    local loaded, library = pcall(ffi.load, place)
    if loaded then
      return library
    end
    failures[#failures + 1] = "  " .. tostring(library)
  end
  error("The springstep library is missing. Build it (meson setup build && meson compile -C build), then set\n" ..
        "SPRINGSTEP_LIBRARY to build/" .. file_name() .. ", or copy that file to the game's folder.\nTried:\n" ..
        table.concat(failures, "\n"), 0)
end

return load_library()
