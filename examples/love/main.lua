-- SPDX-License-Identifier: MIT
-- A rope hangs from the pointer.
--
--     LUA_PATH='build/?.lua;;' love examples/love
--
-- The first particle is pinned and follows the pointer at a limited speed. Steps are fixed. Positions are drawn at the
-- time of the frame, `clock.pending` after the last step. Lengths are in metres; y points down, as on the screen.
local ffi = require "ffi"
local spring = require "springstep"

local N, STEPS = 36, 16 -- particles; steps per frame of 1/60 s
local dt = 1 / 60 / STEPS -- [s]
local spacing, stiffness, damping, mass, ball = 0.03, 3000, 0.2, 0.02, 0.25 -- [m] [N/m] [N s/m] [kg] [kg]
local pixels = 260 -- per metre
local wave = spacing * math.sqrt(stiffness / mass) -- [m/s] wave speed, at which the rope can follow

local scene, clock, hand, position, velocity, whole, step_cost

local must = spring.must

local function start(x, y)
  local grid = ffi.new("spring_grid", {count = {N, 1, 1}, axes = 2, spacing = spacing, stiffness = stiffness,
                                       damping = damping, pinned = spring.SPRING_GRID_FIRST_X})
  position, velocity = ffi.new("double[?]", 2 * N), ffi.new("double[?]", 2 * N)
  local pinned = ffi.new("uint8_t[?]", N)
  local link, masses = ffi.new("spring_link[?]", N - 1), ffi.new("double[?]", N, mass)
  must(spring.spring_grid_fill(grid, position, pinned, link), "grid")
  for i = 0, N - 1 do -- the grid is along x; turn it down from the pointer, slightly to the side
    local along = position[2 * i]
    position[2 * i], position[2 * i + 1] = x + 0.28 * along, y + 0.96 * along
    masses[i] = i < N - 1 and mass or ball
  end
  local def = ffi.new("spring_scene_def")
  def.axes, def.flags, def.particles, def.links = 2, spring.SPRING_SCENE_EDITABLE, N, N - 1
  def.position, def.mass, def.pinned, def.link = position, masses, pinned, link
  def.gravity[1], def.drag = 9.81, 0.02
  scene = spring.scene(def)
  assert(dt < 0.5 * spring.spring_scene_stable_step(scene, spring.SPRING_LEAPFROG), "this step is too long")

  clock, hand, whole, step_cost = ffi.new("spring_clock"), ffi.new("double[2]"), {}, 0
  for i = 1, N - 1 do
    whole[i] = true -- the link between particles i - 1 and i
  end
end

-- The pin moves towards the pointer at no more than half the wave speed of the rope; see docs/dragging.md. The pointer is
-- where it is in this frame, `time` after the time of the scene.
local function reach(x, y, time)
  must(spring.spring_scene_get(scene, spring.SPRING_POSITION, hand, 0, 0, 1), "get")
  local dx, dy, most = x - hand[0], y - hand[1], 0.5 * wave * time
  local part = math.min(1, most / math.max(math.sqrt(dx * dx + dy * dy), 1e-9))
  hand[0], hand[1] = hand[0] + part * dx, hand[1] + part * dy
  must(spring.spring_scene_drive(scene, 0, hand, time), "drive")
end

function love.load()
  start(love.graphics.getWidth() / 2 / pixels, 0.3)
end

function love.update(frame)
  local n = tonumber(spring.spring_clock_tick(clock, frame, dt, 6 * STEPS, nil))
  if n == 0 then
    return
  end
  local x, y = love.mouse.getPosition()
  local before = love.timer.getTime()
  reach(x / pixels, y / pixels, n * dt + clock.pending)
  must(spring.spring_scene_advance(scene, spring.SPRING_LEAPFROG, dt, n), "advance")
  local cost = (love.timer.getTime() - before) / n
  step_cost = step_cost + (step_cost > 0 and 0.05 or 1) * (cost - step_cost)
end

-- The position of a particle on the screen [pixels].
local function at(i)
  local x = position[2 * i] + clock.pending * velocity[2 * i]
  local y = position[2 * i + 1] + clock.pending * velocity[2 * i + 1]
  return x * pixels, y * pixels
end

-- A click cuts the rope in the middle of the piece that hangs from the pointer.
function love.mousepressed()
  local hanging = 0
  while whole[hanging + 1] do
    hanging = hanging + 1
  end
  if hanging > 1 then
    local i = math.ceil(hanging / 2) + 1
    local cut = ffi.new("spring_link")
    must(spring.spring_scene_get_link(scene, i - 1, cut), "get link")
    cut.stiffness, cut.damping = 0, 0
    must(spring.spring_scene_set_link(scene, i - 1, cut), "cut")
    whole[i] = false
  end
end

function love.keypressed(key)
  if key == "r" then
    local x, y = love.mouse.getPosition()
    start(x / pixels, y / pixels)
  elseif key == "escape" then
    love.event.quit()
  end
end

-- Draws intact links dark, then lighter and narrower, so that the rope looks round, with discs at the joints.
local function draw_rope()
  for _, look in ipairs {{11, 0.36, 0.26, 0.16}, {8, 0.60, 0.45, 0.28}, {4, 0.82, 0.67, 0.44}} do
    love.graphics.setLineWidth(look[1])
    love.graphics.setColor(look[2], look[3], look[4])
    for i = 1, N - 1 do
      if whole[i] then
        local ax, ay = at(i - 1)
        local bx, by = at(i)
        love.graphics.line(ax, ay, bx, by)
        love.graphics.circle("fill", ax, ay, look[1] / 2)
        love.graphics.circle("fill", bx, by, look[1] / 2)
      end
    end
  end
end

local function draw_ball(x, y, radius)
  for i = 0, 20 do -- brighter discs towards the light
    local part = i / 20
    love.graphics.setColor(0.20 + 0.45 * part, 0.26 + 0.48 * part, 0.36 + 0.50 * part)
    love.graphics.circle("fill", x - 0.35 * radius * part, y - 0.4 * radius * part, radius * (1 - 0.85 * part))
  end
end

function love.draw()
  love.graphics.clear(0.13, 0.15, 0.20)
  must(spring.spring_scene_get(scene, spring.SPRING_POSITION, position, 0, 0, N), "get")
  must(spring.spring_scene_get(scene, spring.SPRING_VELOCITY, velocity, 0, 0, N), "get")
  draw_rope()
  local x, y = at(N - 1)
  draw_ball(x, y, 26)
  x, y = at(0)
  love.graphics.setColor(love.math.colorFromBytes(255, 214, 64))
  love.graphics.setLineWidth(3)
  love.graphics.circle("line", x, y, 10)
  love.graphics.setColor(0.75, 0.78, 0.83)
  local text = "springstep %s: leapfrog, %d steps a frame, %.1f us a step"
  love.graphics.print(text:format(ffi.string(spring.spring_version()), STEPS, 1e6 * step_cost), 16, 14)
  love.graphics.print("move the mouse; a click cuts; R starts again; Esc", 16, 32)
end
