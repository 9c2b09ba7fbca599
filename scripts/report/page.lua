-- A report: one page that needs nothing else. It is given results.json as tables: of a sweep, or of
-- checks against theory.
local h = require "html"
local bars, checks, data, found, front = require "bars", require "checks", require "data", require "found", require "front"
local head, lines, pictures, rows, style = require "head", require "lines", require "pictures", require "rows", require "style"

-- The title, and what stands in the page.
local function sweep_of(results)
  local sweep = data.read(results)
  local plots, said
  if sweep.chosen then -- a search goes where it is led, not along axes
    plots, said = found(sweep), {}
  else
    plots, said = lines(sweep)
  end
  local cost, sentence = front(sweep)
  said[#said + 1] = sentence
  return sweep.title .. " · roil bench", {
    head(sweep, said),
    sweep.chosen and { plots, cost } or { cost, plots },
    bars(sweep),
    rows(sweep),
    pictures(sweep),
    h.footer { "Made by roil ", sweep.roil, " from results.json beside this page." } }
end

return function(results)
  local title, content = (results.checks and checks or sweep_of)(results)
  return "<!DOCTYPE html>\n" .. h.render(h.html { lang = "en",
    h.head {
      h.meta { charset = "utf-8" },
      -- Whatever a page's text might try, there is nothing that it could load.
      h.meta { ["http-equiv"] = "Content-Security-Policy",
               content = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'" },
      h.meta { name = "viewport", content = "width=device-width, initial-scale=1" },
      h.meta { name = "color-scheme", content = "light dark" },
      h.title(title),
      h.style(h.raw(style)) },
    h.body(h.main(content)) })
end
