# encoding: ascii-8bit

Gem::Specification.new do |s|
  s.name = 'openc3-cosmos-hilcam'
  s.version = ENV['VERSION'] || '0.3.0'
  s.summary = 'Commands and telemetry of hilcam, an emulator of a spacecraft camera'
  s.authors = ['The authors of hilcam']
  s.licenses = ['Apache-2.0']
  s.platform = Gem::Platform::RUBY
  s.required_ruby_version = '>= 3.0'
  s.files = Dir.glob('targets/**/*') + %w(Rakefile README.md plugin.txt)
end
