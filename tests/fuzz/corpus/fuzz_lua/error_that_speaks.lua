error(setmetatable({}, { __tostring = function() return "mine" end }))
