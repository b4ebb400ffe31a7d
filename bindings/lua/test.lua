-- SPDX-License-Identifier: MIT
-- springstep.lua has the whole library, as the C compiler sees it, and its bits. Prints TAP.
--     luajit test.lua SOURCE-ROOT         with springstep.lua in LUA_PATH, and the tools in PATH
local ffi = require "ffi"
local spring = require "springstep"
local root = ...

local count = 0
local function holds(what, test)
  count = count + 1
  local done, said = pcall(test)
  print(("%s %d - %s"):format(done and "ok" or "not ok", count, what))
  if not done then
    print("# " .. tostring(said):gsub("\n", "\n# "))
  end
end

local function same(got, want, what)
  if got ~= want then
    error(("%s: %s, should be %s"):format(what, tostring(got), tostring(want)), 2)
  end
end

local function refused(message, ...)
  local done, said = pcall(...)
  assert(not done, "was not refused")
  assert(tostring(said):find(message, 1, true), tostring(said))
end

local function read(file)
  local opened = assert(io.open(root .. "/" .. file))
  local text = opened:read("*a")
  opened:close()
  return text
end

local function output(command)
  local program = assert(io.popen(command))
  local text = program:read("*a")
  program:close()
  return text
end

-- --- all of it

holds("every function is there", function()
  local functions = 0
  for name in read("tests/headers/exports.txt"):gmatch("%S+") do
    assert(ffi.typeof(spring[name]))
    functions = functions + 1
  end
  assert(functions > 50)
end)

-- The compiler has held what interface.c says against the headers; here the addresses have as many bits.
local layout = read("tests/headers/interface.c")
local here = ffi.abi("64bit") and 1 or 2

holds("a status becomes an error: some springs of a batch fail, and all others advance", function()
  local x, v, w = ffi.new("double[2]", 1, 0 / 0), ffi.new("double[2]"), ffi.new("double[2]", 40, 40)
  local batch = ffi.new("spring_batch", {count = 2, x = x, v = v, omega2 = w})
  local failed = ffi.new("uint8_t[2]")
  refused("advance: some springs of the batch failed", function()
    spring.must(spring.spring_batch_advance_marked(batch, spring.SPRING_LEAPFROG, 1 / 240, 1, failed), "advance")
  end)
  same(failed[0], tonumber(spring.SPRING_OK), "spring 0")
  same(failed[1], tonumber(spring.SPRING_EINVAL), "spring 1")
  assert(x[0] < 1)
end)

holds("structures have the compiler's sizes", function()
  local seen = 0
  for name, wide, narrow in layout:gmatch("\nSIZE%((%g+), (%d+), (%d+)%)") do
    same(ffi.sizeof(name), tonumber(({wide, narrow})[here]), name)
    seen = seen + 1
  end
  assert(seen > 10)
end)

holds("fields lie where the compiler puts them", function()
  local seen = 0
  for name, field, wide, narrow in layout:gmatch("\nAT%((%g+), (%g+), (%d+), (%d+)%)") do
    same(ffi.offsetof(name, field), tonumber(({wide, narrow})[here]), name .. "." .. field)
    seen = seen + 1
  end
  assert(seen > 50)
end)

holds("enumerators and macros have the compiler's values", function()
  local seen = 0
  for name, value in layout:gmatch("\nVALUE%((%g+), (%d+)%)") do
    same(tonumber(spring[name]), tonumber(value), name)
    seen = seen + 1
  end
  assert(seen > 25)
end)

holds("its version is that of the header", function()
  same(ffi.string(spring.spring_version()), read("include/springstep/version.h"):match('SPRING_VERSION "(.-)"'), "version")
end)

-- --- the same bits

local methods = {}
for place = 0, spring.SPRING_METHOD_COUNT - 1 do
  local number = spring.spring_method_at(place)
  methods[#methods + 1] = {number = number, info = spring.spring_method_describe(number)}
end

for _, method in ipairs(methods) do
  local name = ffi.string(method.info.name)
  if method.info.springs then
    holds(name .. ": the bits of spring-run", function()
      local row = {output("spring-run --method " .. name .. " --duration 12 --steps 768 --stiffness 2.7 --mass 1.3 " ..
                          "--damping 0.6 --load 0.4 --x0 0.9 --v0 -0.35"):match("([^\t\n]+)\t768\t(%g+)\t(%g+)\t(%g+)\t(%g+)")}
      local s, p = ffi.new("spring_state", 0.9, -0.35), ffi.new("spring_params", 1.3, 2.7, 0.6, 0.4)
      spring.must(spring.spring_advance(s, p, method.number, 12 / 768, 768))
      same(s.x, tonumber(row[3]), "x")
      same(s.v, tonumber(row[4]), "v")
      same(spring.spring_energy(s, p), tonumber(row[5]), "energy")
    end)
  end
end

-- The cloth of spring-scene, in the precision that is asked for.
local function cloth(kind, change)
  local n = 25
  local grid = ffi.new("spring_grid", {count = {n, n, 1}, spacing = 2 / (n - 1), stiffness = 500,
                                       families = 7, axes = 3})
  local particles, links = ffi.new("size_t[1]"), ffi.new("size_t[1]")
  spring.must(spring.spring_grid_size(grid, particles, links), "grid")
  particles, links = tonumber(particles[0]), tonumber(links[0])
  local position, pinned = ffi.new("double[?]", 3 * particles), ffi.new("uint8_t[?]", particles)
  local link = ffi.new("spring_link[?]", links)
  spring.must(spring.spring_grid_fill(grid, position, pinned, link), "grid")
  pinned[0], pinned[n - 1] = 1, 1
  local def = ffi.new(kind .. "_def")
  def.particles, def.links, def.position, def.pinned, def.link = particles, links, position, pinned, link
  def.mass_all, def.drag, def.gravity[2] = 0.01, 0.01, -9.81
  if change then
    change(def, position)
  end
  local scene, bytes = spring[kind:gsub("spring_", "")](def) -- a tail call would let go of the arrays
  return scene, bytes
end

local function state(scene, q)
  local numbers = ffi.new("double[?]", 3 * 625)
  spring.must(spring.spring_scene_get(scene, q, numbers, 0, 0, 625), "get")
  return numbers
end

local function fnv(scene)
  local digest = 0xCBF29CE484222325ULL
  for _, q in ipairs {spring.SPRING_POSITION, spring.SPRING_VELOCITY} do
    local numbers = state(scene, q)
    local bytes = ffi.cast("uint8_t *", numbers)
    for i = 0, ffi.sizeof(numbers) - 1 do
      digest = bit.bxor(digest, 0ULL + bytes[i]) * 0x100000001B3ULL
    end
  end
  return bit.tohex(digest)
end

for _, method in ipairs(methods) do
  local name = ffi.string(method.info.name)
  if method.info.scenes then
    holds(name .. ": the bits of spring-scene", function()
      local scene = cloth("spring_scene", function(def)
        def.flags, def.methods = spring.SPRING_SCENE_FORCE_IGNORES_VELOCITY, bit.lshift(1, tonumber(method.number))
      end)
      -- Euler's cloth lives for a few dozen steps
      local steps = name == "euler" and 32 or 512
      spring.must(spring.spring_scene_advance(scene, method.number, 2 ^ -11, steps), "advance")
      same(fnv(scene), output(("spring-scene --scene cloth --method %s --dt 0x1p-11 --duration %.17g --hash"):format(
        name, steps / 2048)):match("%x+"), "hash")
    end)
  end
end

holds("a snapshot brings back what was", function()
  local scene, bytes = cloth("spring_scene")
  local function on()
    spring.must(spring.spring_scene_advance(scene, spring.SPRING_LEAPFROG, 1e-3, 20), "advance")
    return fnv(scene)
  end
  on()
  local before = ffi.string(scene, bytes)
  local there = on()
  assert(on() ~= there)
  ffi.copy(scene, before, bytes)
  same(on(), there, "hash")
end)

holds("a saved state goes on in another scene", function()
  for _, name in ipairs {"spring_scene", "spring_scenef"} do
    local scene, other = cloth(name), cloth(name)
    local function on(which)
      spring.must(spring[name .. "_advance"](which, spring.SPRING_LEAPFROG, 1e-3, 20), "advance")
      return spring.save(which)
    end
    local state = on(scene)
    on(other)
    spring.load(other, state)
    assert(spring.save(other) == state and on(scene) == on(other), "the same bytes")
    refused("load: damaged", spring.load, other, state:sub(1, -2))
    refused("save: not a scene", spring.save, ffi.cast("void *", scene))
    refused("load: the state of a scene with another definition", spring.load, cloth(name == "spring_scene" and "spring_scenef" or "spring_scene"), state)
  end
end)

holds("a scene keeps its memory, and nothing else of what it was made from", function()
  local scene, bytes = cloth("spring_scene")
  local before = ffi.string(scene, bytes)
  for _ = 1, 20 do
    collectgarbage()
    local other = ffi.new("uint8_t[?]", bytes + 64)
    ffi.fill(other, bytes + 64, 255)
  end
  assert(ffi.string(scene, bytes) == before, "overwritten")
end)

holds("a scene whose reference is gone is freed", function()
  local function kilobytes()
    collectgarbage()
    collectgarbage()
    return collectgarbage("count")
  end
  local before = kilobytes()
  local _, bytes = cloth("spring_scene")
  for _ = 1, 20 do
    cloth("spring_scene")
  end
  assert(kilobytes() - before < 2 * bytes / 1024, "memory is kept")
end)

holds("a force written in Lua: weight", function()
  local calls = 0
  local weight = ffi.cast("spring_scene_force_fn *", function(_, _, particles, _, _, force)
    calls = calls + 1
    for i = 0, tonumber(particles) - 1 do
      force[2][i] = force[2][i] - 0.01 * 9.81
    end
  end)
  local scene = cloth("spring_scene", function(def)
    def.gravity[2], def.force = 0, weight
  end)
  local function advance()
    return spring.spring_scene_advance(scene, spring.SPRING_LEAPFROG, 1e-3, 50)
  end
  jit.off(advance) -- or LuaJIT says "bad callback", once the call is compiled
  spring.must(advance(), "advance")
  weight:free()
  same(calls, 2 * 50, "evaluations") -- of leapfrog, which keeps none where velocities may be used
  local middle = state(scene, spring.SPRING_POSITION)[3 * 312 + 2]
  assert(math.abs(middle + 9.81 * 0.05 ^ 2 / 2) < 0.002, middle) -- free fall, less drag and the pull of two corners
end)

holds("the program in docs/lua.md runs", function()
  local said
  local program = assert(loadstring(read("docs/lua.md"):match("\n```lua\n(.-)\n```")))
  setfenv(program, setmetatable({print = function(text) said = text end}, {__index = _G}))()
  assert(said:find("^the end is at 1%.%d%d m, %-0%.%d%d m$"), said) -- of a rope of 1.9 m that has begun to fall
end)

holds("a cloth on a sphere, and which particles touch it", function()
  local scene = cloth("spring_scene", function(def)
    def.colliders, def.particle_radius = 1, 0.01
  end)
  local ball = ffi.new("spring_collider[1]")
  ball[0].shape, ball[0].radius, ball[0].friction = spring.SPRING_SPHERE, 0.3, 0.5
  ball[0].at[0], ball[0].at[1], ball[0].at[2] = 1, 1, -0.4
  spring.must(spring.spring_scene_set_colliders(scene, ball, 1), "colliders")
  spring.must(spring.spring_scene_advance(scene, spring.SPRING_LEAPFROG, 1e-3, 500), "advance")
  local mask = ffi.new("uint32_t[625]")
  spring.must(spring.spring_scene_touching(scene, mask, 0, 625), "touching")
  local touching = 0
  for i = 0, 624 do
    touching = touching + mask[i]
  end
  assert(touching > 3 and touching < 625, touching)
  ball[0].restitution = 2
  refused(ffi.string(spring.spring_status_string(spring.SPRING_EINVAL)), function()
    spring.must(spring.spring_scene_set_colliders(scene, ball, 1), "colliders")
  end)
end)

-- --- invalid input

holds("a scene in float, and a wrong mass in it", function()
  local scene = cloth("spring_scenef")
  spring.must(spring.spring_scenef_advance(scene, spring.SPRING_LEAPFROG, 1e-3, 10), "advance")
  assert(math.abs(spring.spring_scenef_time(scene) - 0.01) < 1e-8) -- ten times the float next to 1e-3
  refused("mass_all[0]: " .. ffi.string(spring.spring_status_string(spring.SPRING_EINVAL)), cloth, "spring_scenef", function(def)
    def.mass_all = -1
  end)
end)

holds("an error names the field and the place", function()
  refused("position[5]: ", cloth, "spring_scene", function(_, position)
    position[16] = 0 / 0
  end)
end)

holds("an error says what was being done", function()
  local s, p = ffi.new("spring_state", 1), ffi.new("spring_params", 1, -1)
  refused("advance: " .. ffi.string(spring.spring_status_string(spring.SPRING_EINVAL)), function()
    spring.must(spring.spring_advance(s, p, spring.SPRING_RK4, 0.1, 1), "advance")
  end)
  same(s.x, 1, "x")
end)

holds("what is not declared is missed", function()
  refused("spring_nonsense", function()
    return spring.spring_nonsense
  end)
end)

holds("it may be loaded again", function()
  package.loaded.springstep = nil
  local again = require "springstep"
  assert(again ~= spring)
  local s = ffi.new("spring_state", 1)
  again.must(again.spring_advance(s, ffi.new("spring_params", 1, 40), again.SPRING_RK4, 0.01, 1), "advance")
  assert(s.x < 1)
end)

holds("no library: it says where it was looked for", function()
  local said = output("SPRINGSTEP_LIBRARY=/nonexistent/library.so luajit -e 'require \"springstep\"' 2>&1")
  assert(said:find("The springstep library is missing", 1, true) and said:find("/nonexistent/library.so", 1, true), said)
end)

holds("in LÖVE the library may be in a folder of the game", function()
  local file = package.searchpath("springstep", package.path)
  local function folder(path)
    return function() return path end
  end
  love = {filesystem = {getSource = folder "/nonexistent", getSourceBaseDirectory = folder(file:match("^(.*)/"))}}
  local again = loadstring(io.open(file):read("*a"), "=without a folder of its own")()
  love = nil
  again.must(again.SPRING_OK)
end)

print("1.." .. count)
